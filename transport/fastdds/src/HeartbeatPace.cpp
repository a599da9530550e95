#include "HeartbeatPace.h"

#include <algorithm>
#include <utility>

#include "guard/DeliveryCheck.h"

namespace Rabit::FastDds
{

using namespace Rtps;

HeartbeatPace::Gaps HeartbeatPace::GapsOf(EntityId writer)
{
    return IsBuiltin(writer) ? OfDiscovery : OfTopics;
}

bool HeartbeatPace::MayGo(std::uint64_t destination, const LoneHeartbeat &heartbeat, TimePoint now)
{
    const Gaps gaps = GapsOf(heartbeat.Writer);
    const Place place{heartbeat.Writer, destination, heartbeat.Peer};
    if (_sent.size() >= Most && !_sent.contains(place))
    {
        _sent.clear();
    }
    const auto [found, isNew] = _sent.try_emplace(place);
    Sent &sent = found->second;
    if (isNew || sent.First != heartbeat.First || sent.Last != heartbeat.Last)
    {
        sent = {
            .First = heartbeat.First, .Last = heartbeat.Last, .Next = now + gaps.First, .Gap = gaps.First};
        return true;
    }
    if (now < sent.Next)
    {
        return false;
    }
    sent.Gap = std::min(2 * sent.Gap, gaps.Longest);
    sent.Next = now + sent.Gap;
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
    const std::chrono::milliseconds first = GapsOf(acknowledgement.Writer).First;
    for (auto at = _sent.lower_bound(Place{acknowledgement.Writer, 0, {}});
         at != _sent.end() && std::get<0>(at->first) == acknowledgement.Writer; ++at)
    {
        // A reader that requests something is answered at once.
        const bool isTheirs = std::get<GuidPrefix>(at->first) == acknowledgement.Peer;
        at->second.Gap = first;
        at->second.Next = std::min(at->second.Next, isTheirs && acknowledgement.Asks ? now : now + first);
    }
}

}  // namespace Rabit::FastDds
