#include "HeartbeatPace.h"

#include <algorithm>
#include <utility>

#include "guard/DeliveryCheck.h"

namespace Rabit::FastDds
{

using namespace Rtps;

bool HeartbeatPace::MayGo(std::uint64_t destination, const LoneHeartbeat &heartbeat, TimePoint now)
{
    const Place place{heartbeat.Writer, destination, heartbeat.Peer};
    if (_sent.size() >= Most && !_sent.contains(place))
    {
        _sent.clear();
    }
    const Sent anew{heartbeat.First, heartbeat.Last,
                    Backoff(IsBuiltin(heartbeat.Writer) ? OfDiscovery : OfTopics), now};
    Sent &sent = _sent.try_emplace(place, anew).first->second;
    if (sent.First != heartbeat.First || sent.Last != heartbeat.Last)
    {
        sent = anew;
    }
    if (now < sent.Next)
    {
        return false;
    }
    sent.Next = now + sent.Gap.Next();
    return true;
}

void HeartbeatPace::OnAcknowledgement(const Acknowledgement &acknowledgement, TimePoint now)
{
    const Reader reader{acknowledgement.Writer, acknowledgement.Peer, acknowledgement.Reader};
    if (_acknowledged.size() >= Most && !_acknowledged.contains(reader))
    {
        _acknowledged.clear();
    }
    std::int64_t &before = _acknowledged[reader];
    // A reader that now acknowledges less has started anew.
    const bool isNew = acknowledgement.Base != std::exchange(before, acknowledgement.Base);
    if (!isNew && !acknowledgement.Asks)
    {
        return;
    }
    for (auto at = _sent.lower_bound(Place{acknowledgement.Writer, 0, {}});
         at != _sent.end() && std::get<0>(at->first) == acknowledgement.Writer; ++at)
    {
        // A reader that requests something is answered at once.
        const bool isTheirs = std::get<GuidPrefix>(at->first) == acknowledgement.Peer;
        at->second.Gap.Reset();
        const TimePoint next = now + at->second.Gap.Next();
        at->second.Next = std::min(at->second.Next, isTheirs && acknowledgement.Asks ? now : next);
    }
}

}  // namespace Rabit::FastDds
