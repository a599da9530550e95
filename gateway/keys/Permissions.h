#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "keys/Access.h"
#include "keys/Certificates.h"

namespace Rabit::Keys
{

// The permissions of one node in a document, as far as vendors heed it.
struct Permissions
{
    struct Rule
    {
        bool Allows = true;
        std::vector<std::pair<int, int>> Domains{};  // from, to
        std::vector<TopicAccess>
            Publish{};  // each topic with the partitions that it is listed with; none: ""
        std::vector<TopicAccess> Subscribe{};

        bool IsIn(int domain) const;
    };

    std::string Subject;  // as SubjectName::Text
    std::string From;     // as the document has them
    std::string To;
    std::vector<Rule> Rules;
    bool AllowsTheRest = false;

    // True if a rule allows the access before one forbids it, or if no rule matches and AllowsTheRest is
    // true.
    bool MayPublish(int domain, const TopicAccess &access) const;
    bool MaySubscribe(int domain, const TopicAccess &access) const;
};

// Largest signed document, in bytes. A vendor shows it and its certificate in one message, into which a
// larger one does not fit.
inline constexpr std::size_t LargestDocument = 12000;

// Returns the text of a document that allows exactly this access, to be signed.
std::string PermissionsText(const SubjectName &subject, const Validity &validity, const Access &access);

// Returns the grants in a document. Throws KeysError, which names `file`.
std::vector<Permissions> ReadPermissions(const std::string &text, const std::string &file);

}  // namespace Rabit::Keys
