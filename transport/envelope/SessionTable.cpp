#include "envelope/SessionTable.h"

#include <algorithm>
#include <utility>

#include "guard/RtpsMessage.h"

namespace Rabit::Envelope
{

SessionTable::SessionTable(const End &self, std::string name, std::span<const RtpsHeader> headers)
    : _self(self), _ownTag(TagOf(self)), _name(std::move(name))
{
    for (const RtpsHeader &header : headers)
    {
        _ownPrefixes.push_back(Rtps::SenderOf(header));
    }
}

Session *SessionTable::Find(SessionTag tag) const
{
    const auto found = _sessions.find(tag);
    return found == _sessions.end() ? nullptr : found->second.get();
}

SessionTable::Result SessionTable::Take(const Facts &facts, TimePoint now)
{
    const SessionTag tag = TagOf(facts.Sender);
    Session *known = Find(tag);
    const bool isSame = known != nullptr && known->Sender() == facts.Sender;
    if (isSame && known->Headers() != facts.Headers)
    {
        return {.Verdict = ClaimVerdict::OtherHeaders, .Holder = known->Certificate().Content.Name};
    }
    if (tag == _ownTag)
    {
        return {.Verdict = ClaimVerdict::TagTaken, .Holder = _name};
    }
    // A proof displaces a mere claim.
    if (known != nullptr && !isSame && (known->IsProven() || !facts.LiveAt))
    {
        return {.Verdict = ClaimVerdict::TagTaken, .Holder = known->Certificate().Content.Name};
    }
    if (const std::string *const holder = HolderOf(facts))
    {
        return {.Verdict = ClaimVerdict::PrefixTaken, .Holder = *holder};
    }
    if (!isSame && known != nullptr)
    {
        _sessions.erase(tag);
        known = nullptr;
    }
    if (!MakeRoom(facts, known))
    {
        return {.Verdict = ClaimVerdict::TooMany, .Holder = facts.Certificate->Content.Name};
    }
    if (known == nullptr)
    {
        auto made = std::make_unique<Session>(facts.Sender, facts.Certificate, facts.Headers, now);
        known = _sessions.emplace(tag, std::move(made)).first->second.get();
    }
    if (facts.LiveAt)
    {
        known->Prove(facts.Number, *facts.LiveAt, now);
    }
    return {.Verdict = facts.LiveAt ? ClaimVerdict::Proven
                       : isSame     ? ClaimVerdict::Known
                                    : ClaimVerdict::Added,
            .Of = known};
}

const std::string *SessionTable::HolderOf(const Facts &facts) const
{
    for (const RtpsHeader &header : facts.Headers)
    {
        const Rtps::GuidPrefix prefix = Rtps::SenderOf(header);
        if (facts.Sender.Certificate != _self.Certificate &&
            std::find(_ownPrefixes.begin(), _ownPrefixes.end(), prefix) != _ownPrefixes.end())
        {
            return &_name;
        }
        for (const auto &[tag, session] : _sessions)
        {
            if (session->IsProven() && session->Sender().Certificate != facts.Sender.Certificate &&
                session->Binds(prefix))
            {
                return &session->Certificate().Content.Name;
            }
        }
    }
    return nullptr;
}

template <typename Fits>
SessionTable::Map::iterator SessionTable::LongestSilent(const Fits &fits)
{
    auto found = _sessions.end();
    for (auto each = _sessions.begin(); each != _sessions.end(); ++each)
    {
        if (fits(*each->second) &&
            (found == _sessions.end() || each->second->Heard() < found->second->Heard()))
        {
            found = each;
        }
    }
    return found;
}

bool SessionTable::MakeRoom(const Facts &facts, const Session *known)
{
    // A session that is proven by this claim becomes one of the proven ones.
    const bool isCounted = known == nullptr || (facts.LiveAt && !known->IsProven());
    const auto isAlike = [&](const Session &session)
    {
        return &session != known && session.Sender().Certificate == facts.Sender.Certificate &&
               session.IsProven() == facts.LiveAt.has_value();
    };
    const auto alike = static_cast<std::size_t>(std::count_if(
        _sessions.begin(), _sessions.end(), [&isAlike](const auto &each) { return isAlike(*each.second); }));
    if (isCounted && alike >= (facts.LiveAt ? MostProvenOfOne : MostUnprovenOfOne))
    {
        _sessions.erase(LongestSilent(isAlike));
    }
    if (known != nullptr || _sessions.size() < Most)
    {
        return true;
    }
    const auto unproven = LongestSilent([](const Session &session) { return !session.IsProven(); });
    if (unproven == _sessions.end())
    {
        return false;
    }
    _sessions.erase(unproven);
    return true;
}

void SessionTable::EndRevoked(const EpochSecrets &epochs)
{
    std::erase_if(_sessions, [&epochs](const auto &each)
                  { return epochs.IsRevoked(each.second->Certificate().Content.Number); });
}

std::shared_ptr<KnownCertificate> SessionTable::CertificateOf(const Hash &hash) const
{
    for (const auto &[tag, session] : _sessions)
    {
        if (session->Sender().Certificate == hash)
        {
            return session->CertificateOwner();
        }
    }
    return nullptr;
}

}  // namespace Rabit::Envelope
