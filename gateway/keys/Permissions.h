#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "keys/Access.h"
#include "keys/Certificates.h"

namespace Rabit::Keys
{

// What a document of permissions says of one node, as far as vendors heed it.
struct Permissions
{
    struct Rule
    {
        bool Allows = true;
        std::vector<std::pair<int, int>> Domains{};  // from, to
        std::vector<TopicAccess>
            Publish{};  // each topic with the partitions that it is listed with; none: ""
        std::vector<TopicAccess> Subscribe{};
    };

    std::string Subject;  // as SubjectName::Text
    std::string From;     // as the document has them
    std::string To;
    std::vector<Rule> Rules;
    bool AllowsTheRest = false;

    // Whether a rule allows it before one forbids it.
    bool MayPublish(int domain, const TopicAccess &access) const;
    bool MaySubscribe(int domain, const TopicAccess &access) const;
};

// A signed document that is larger does not fit into the one message in which a vendor shows it, with its
// certificate.
inline constexpr std::size_t LargestDocument = 12000;

// The text of a document, to be signed: exactly this access.
std::string PermissionsText(const SubjectName &subject, const Validity &validity, const Access &access);

// The grants in a document. Throws KeysError; `file` is what it names.
std::vector<Permissions> ReadPermissions(const std::string &text, const std::string &file);

}  // namespace Rabit::Keys
