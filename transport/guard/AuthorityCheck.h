// Compares announcements with the certificates of their senders.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "common/Ledger.h"
#include "guard/DiscoveryCheck.h"

namespace Rabit::Rtps
{

// Tells the content of participants' certificates. Called on receiving threads with the guard's lock held:
// the functions must be quick, and must not call the guard.
struct Authority
{
    // True if the participant may write (else read) the topic.
    std::function<bool(const GuidPrefix &peer, bool write, std::string_view topic)> May;
    // The name in the participant's certificate. Empty: no certificate is bound to the participant, or it is
    // not known yet what May would say.
    std::function<std::optional<std::string>(const GuidPrefix &peer)> NameOf;
};

// Notes what it refuses in the ledger (AuthorityRefusals.h). Not thread-safe.
class AuthorityCheck
{
public:
    using TimePoint = Ledger::TimePoint;

    enum class Answer
    {
        Allowed,
        Forbidden,
        Unknown  // the certificate, or what it allows, has not come yet
    };

    AuthorityCheck(Authority authority, std::shared_ptr<Ledger> ledger)
        : _authority(std::move(authority)), _ledger(std::move(ledger))
    {
    }

    // May the participant have the name that it announces?
    Answer OfParticipant(const GuidPrefix &peer, const Announcement &announcement, TimePoint now);
    // May the participant have the endpoint that it announces? `writer`: of the announcement.
    Answer OfEndpoint(const GuidPrefix &peer, EntityId writer, const Announcement &announcement,
                      TimePoint now);

private:
    Answer Judge(bool isAllowed, const GuidPrefix &peer, EntityId subject,
                 const std::function<AuthorityRefusals::Row()> &row, TimePoint now);

    const Authority _authority;
    const std::shared_ptr<Ledger> _ledger;
};

}  // namespace Rabit::Rtps
