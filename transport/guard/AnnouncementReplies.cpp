#include "guard/AnnouncementReplies.h"

#include <algorithm>
#include <utility>

namespace Rabit::Rtps
{

AnnouncementReplies::AnnouncementReplies(std::chrono::milliseconds period)
    : _silence(std::max(ShortestSilence, 5 * period / 2))
{
}

bool AnnouncementReplies::OnAnnouncement(const GuidPrefix &peer, TimePoint now)
{
    const auto found = _peers.find(peer);
    if (found == _peers.end())
    {
        if (_peers.size() >= MostPeers)
        {
            std::erase_if(
                _peers, [this, now](const auto &entry) { return now - entry.second.Announced >= _silence; });
        }
        if (_peers.size() < MostPeers)
        {
            _peers.emplace(peer, Peer{.Announced = now});
        }
        return false;
    }
    Peer &known = found->second;
    if (now - std::exchange(known.Announced, now) >= _silence)
    {
        known.KnowsUs = false;
        known.Replies = 0;
    }
    if (known.KnowsUs || known.Replies >= MostForOne || (_last && now - *_last < Gap))
    {
        return false;
    }
    ++known.Replies;
    _last = now;
    return true;
}

void AnnouncementReplies::OnAddressed(const GuidPrefix &peer)
{
    if (const auto found = _peers.find(peer); found != _peers.end())
    {
        found->second.KnowsUs = true;
    }
}

void AnnouncementReplies::OnGone(const GuidPrefix &peer)
{
    _peers.erase(peer);
}

}  // namespace Rabit::Rtps
