#include "envelope/BoundPeers.h"

#include <utility>

#include "envelope/Claim.h"
#include "guard/RtpsMessage.h"

namespace Rabit::Envelope
{

bool BoundPeers::Has(SessionTag session) const
{
    const std::lock_guard lock(_mutex);
    return _sessions.contains(session);
}

bool BoundPeers::Bind(const Session &session, SessionTag tag, std::shared_ptr<const Permissions> list,
                      const std::function<bool(SessionTag)> &isGone)
{
    const Certificate &certificate = session.Certificate().Content;
    const auto peer = std::make_shared<const BoundPeer>(BoundPeer{.Session = tag,
                                                                  .Name = certificate.Name,
                                                                  .Number = certificate.Number,
                                                                  .Role = certificate.Role,
                                                                  .List = std::move(list)});
    const std::lock_guard lock(_mutex);
    if (_peers.size() + Claim::MostHeaders > Most)
    {
        std::erase_if(_peers, [&isGone](const auto &each) { return isGone(each.second->Session); });
        std::erase_if(_sessions, isGone);
    }
    if (_peers.size() + Claim::MostHeaders > Most)
    {
        return false;
    }
    for (const RtpsHeader &header : session.Headers())
    {
        _peers[Rtps::SenderOf(header)] = peer;
    }
    _sessions.insert(tag);
    return true;
}

std::shared_ptr<const BoundPeer> BoundPeers::Find(const Rtps::GuidPrefix &prefix) const
{
    const std::lock_guard lock(_mutex);
    const auto found = _peers.find(prefix);
    return found == _peers.end() ? nullptr : found->second;
}

void BoundPeers::RemoveIf(const std::function<bool(const BoundPeer &)> &is)
{
    const std::lock_guard lock(_mutex);
    for (auto each = _peers.begin(); each != _peers.end();)
    {
        if (!is(*each->second))
        {
            ++each;
            continue;
        }
        _sessions.erase(each->second->Session);
        each = _peers.erase(each);
    }
}

std::size_t BoundPeers::Size() const
{
    const std::lock_guard lock(_mutex);
    return _peers.size() + _sessions.size();
}

}  // namespace Rabit::Envelope
