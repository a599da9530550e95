#include "guard/AuthorityCheck.h"

#include "common/SessionLog.h"

namespace Rabit::Rtps
{

namespace
{

std::string ShownName(const std::optional<std::string> &name)
{
    return name ? SessionLog::Printable(*name) : "(no single name)";
}

}  // namespace

AuthorityCheck::Answer AuthorityCheck::OfParticipant(const GuidPrefix &peer, const Announcement &announcement,
                                                     TimePoint now)
{
    const auto known = _authority.NameOf(peer);
    if (!known)
    {
        return Answer::Unknown;
    }
    const auto row = [&]
    {
        return AuthorityRefusals::Row{
            .Node = *known,
            .Text = "the keys of node " + *known + " are used by a node that calls itself " +
                    ShownName(announcement.Name) + ", which is not heard: give it keys of its own"};
    };
    return Judge(announcement.Name == known, peer, ParticipantEntity, row, now);
}

AuthorityCheck::Answer AuthorityCheck::OfEndpoint(const GuidPrefix &peer, EntityId writer,
                                                  const Announcement &announcement, TimePoint now)
{
    const auto known = _authority.NameOf(peer);
    if (!known)
    {
        return Answer::Unknown;
    }
    const bool writes = writer == PublicationsWriter;
    const auto row = [&]
    {
        return AuthorityRefusals::Row{
            .Node = *known,
            .Text = "node " + *known + (writes ? " writes topic " : " reads topic ") +
                    ShownName(announcement.Name) + ", which its permissions do not allow: " +
                    (writes ? "it is not heard there" : "it gets nothing there") +
                    "; sign permissions for it, or take the topic out of its configuration"};
    };
    const bool isAllowed = announcement.Name && _authority.May(peer, writes, *announcement.Name);
    return Judge(isAllowed, peer, announcement.Subject, row, now);
}

AuthorityCheck::Answer AuthorityCheck::Judge(bool isAllowed, const GuidPrefix &peer, EntityId subject,
                                             const std::function<AuthorityRefusals::Row()> &row,
                                             TimePoint now)
{
    if (isAllowed)
    {
        _ledger->OfAuthority().Gone(peer, subject);
        return Answer::Allowed;
    }
    _ledger->OfAuthority().Refused(peer, subject, row(), now);
    return Answer::Forbidden;
}

}  // namespace Rabit::Rtps
