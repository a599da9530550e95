#include "envelope/BoundPeers.h"

#include <algorithm>
#include <utility>

#include "envelope/Claim.h"
#include "guard/RtpsMessage.h"

namespace Rabit::Envelope
{

bool BoundPeers::Has(const Session &session) const
{
    const Serial number = session.Certificate().Content.Number;
    const std::lock_guard lock(_mutex);
    return std::all_of(session.Headers().begin(), session.Headers().end(),
                       [this, number](const RtpsHeader &header)
                       {
                           const auto found = _peers.find(Rtps::SenderOf(header));
                           return found != _peers.end() && found->second->Number == number;
                       });
}

bool BoundPeers::Bind(const Session &session, SessionTag tag, std::shared_ptr<const Permissions> list,
                      const std::function<bool(SessionTag)> &isGone)
{
    const Certificate &certificate = session.Certificate().Content;
    const auto peer = std::make_shared<const BoundPeer>(BoundPeer{.Session = tag,
                                                                  .Name = certificate.Name,
                                                                  .Number = certificate.Number,
                                                                  .Role = certificate.Role,
                                                                  .List = std::move(list),
                                                                  .HasEnded = false});
    const std::lock_guard lock(_mutex);
    if (_peers.size() + Claim::MostHeaders > Most)
    {
        std::erase_if(_peers, [&isGone](const auto &each) { return isGone(each.second->Session); });
    }
    const bool isTaken =
        std::any_of(session.Headers().begin(), session.Headers().end(),
                    [this, &peer](const RtpsHeader &header)
                    {
                        const auto found = _peers.find(Rtps::SenderOf(header));
                        return found != _peers.end() && found->second->Number != peer->Number;
                    });
    if (isTaken || _peers.size() + Claim::MostHeaders > Most)
    {
        return false;
    }
    for (const RtpsHeader &header : session.Headers())
    {
        _peers[Rtps::SenderOf(header)] = peer;
    }
    return true;
}

std::shared_ptr<const BoundPeer> BoundPeers::Find(const Rtps::GuidPrefix &prefix) const
{
    const std::lock_guard lock(_mutex);
    const auto found = _peers.find(prefix);
    return found == _peers.end() || found->second->HasEnded ? nullptr : found->second;
}

void BoundPeers::EndIf(const std::function<bool(const BoundPeer &)> &is)
{
    const std::lock_guard lock(_mutex);
    for (auto &[prefix, peer] : _peers)
    {
        if (!peer->HasEnded && is(*peer))
        {
            BoundPeer ended = *peer;
            ended.HasEnded = true;
            peer = std::make_shared<const BoundPeer>(std::move(ended));
        }
    }
}

std::size_t BoundPeers::Size() const
{
    const std::lock_guard lock(_mutex);
    return _peers.size();
}

}  // namespace Rabit::Envelope
