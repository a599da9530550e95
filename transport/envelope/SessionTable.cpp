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
        Displace(_sessions.find(tag));
        known = nullptr;
    }
    if (!MakeRoom(facts, known, now))
    {
        return {.Verdict = ClaimVerdict::TooMany, .Holder = facts.Certificate->Content.Name};
    }
    if (known == nullptr)
    {
        auto made = std::make_unique<Session>(facts.Sender, facts.Certificate, facts.Headers, now);
        known = _sessions.emplace(tag, std::move(made)).first->second.get();
        if (const std::uint64_t *const highest = _displaced.Find(facts.Sender))
        {
            known->Window().SetFloor(*highest + 1);
            _displaced.Erase(facts.Sender);
        }
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

bool SessionTable::Holds(const Session &session, TimePoint now)
{
    return session.IsProven() && now - session.Heard() <= HoldsFor;
}

bool SessionTable::BindsAnyOf(const Session &session, const Facts &facts)
{
    return std::any_of(facts.Headers.begin(), facts.Headers.end(),
                       [&session](const RtpsHeader &header)
                       { return session.Binds(Rtps::SenderOf(header)); });
}

// However long the holder was silent: the vendor may remember its writers, and would take what another node
// sends in their names.
const std::string *SessionTable::HolderOf(const Facts &facts) const
{
    const bool isOwn = std::any_of(facts.Headers.begin(), facts.Headers.end(),
                                   [this](const RtpsHeader &header)
                                   {
                                       return std::find(_ownPrefixes.begin(), _ownPrefixes.end(),
                                                        Rtps::SenderOf(header)) != _ownPrefixes.end();
                                   });
    if (isOwn && facts.Sender.Certificate != _self.Certificate)
    {
        return &_name;
    }
    for (const auto &[tag, session] : _sessions)
    {
        if (session->IsProven() && session->Sender().Certificate != facts.Sender.Certificate &&
            BindsAnyOf(*session, facts))
        {
            return &session->Certificate().Content.Name;
        }
    }
    return nullptr;
}

void SessionTable::Displace(Map::iterator which)
{
    _displaced.Put(which->second->Sender(), which->second->Window().Highest());
    _sessions.erase(which);
}

bool SessionTable::WasTaken(const End &sender, std::uint64_t number) const
{
    const std::uint64_t *const highest = _displaced.Find(sender);
    return highest != nullptr && number <= *highest;
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

bool SessionTable::MakeRoom(const Facts &facts, const Session *known, TimePoint now)
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
        Displace(LongestSilent(isAlike));
    }
    if (known != nullptr || _sessions.size() < Most)
    {
        return true;
    }
    // Mere claims displace each other alone.
    const auto silent =
        LongestSilent([&](const Session &session)
                      { return !session.IsProven() || (facts.LiveAt && !Holds(session, now)); });
    if (silent == _sessions.end())
    {
        return false;
    }
    Displace(silent);
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
