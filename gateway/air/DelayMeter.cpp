#include "air/DelayMeter.h"

#include <algorithm>

namespace Rabit
{

void DelayMeter::Peer::Begin(std::uint64_t incarnation, Duration offset, Duration now)
{
    *this = Peer{};
    Incarnation = incarnation;
    Least.fill(None);
    Least.front() = offset;
    BucketEnd = now + Bucket;
}

void DelayMeter::Peer::Turn(Duration now)
{
    for (std::size_t turns = 0; now >= BucketEnd && turns < Buckets; ++turns)
    {
        std::move_backward(Least.begin(), Least.end() - 1, Least.end());
        Least.front() = None;
        BucketEnd += Bucket;
    }
    if (now >= BucketEnd)
    {
        BucketEnd = now + Bucket;
    }
}

DelayMeter::Duration DelayMeter::Peer::Quickest() const
{
    return *std::min_element(Least.begin(), Least.end());
}

DelayMeter::Peer &DelayMeter::PeerOf(std::string_view node)
{
    const auto found = _peers.find(node);
    if (found != _peers.end())
    {
        return found->second;
    }
    if (_peers.size() == MostPeers)
    {
        _peers.erase(std::min_element(_peers.begin(), _peers.end(),
                                      [](const auto &a, const auto &b)
                                      { return a.second.ArrivedAt < b.second.ArrivedAt; }));
    }
    return _peers.emplace(node, Peer{}).first->second;
}

void DelayMeter::Heard(std::string_view node, std::uint64_t incarnation, Duration sentAt, Duration arrivedAt)
{
    if (sentAt < Duration(0) || sentAt > LatestTime)
    {
        return;
    }
    Peer &peer = PeerOf(node);
    const Duration offset = arrivedAt - sentAt;
    if (peer.Incarnation != incarnation)
    {
        peer.Begin(incarnation, offset, arrivedAt);
    }
    peer.Turn(arrivedAt);
    peer.Least.front() = std::min(peer.Least.front(), offset);
    if (sentAt < peer.SentAt)
    {
        return;  // overtaken
    }
    if (offset - peer.Quickest() > Longest)
    {
        peer.Begin(incarnation, offset, arrivedAt);
    }
    peer.SentAt = sentAt;
    peer.ArrivedAt = arrivedAt;
    peer.Delay = offset - peer.Quickest();
    peer.Told = false;
    if (peer.Delay > Late)
    {
        peer.TellUntil = arrivedAt + Echo;
    }
}

DelayMeter::Duration DelayMeter::DelayOf(std::string_view node, std::uint64_t incarnation, Duration sentAt,
                                         Duration arrivedAt) const
{
    const auto found = _peers.find(node);
    if (found == _peers.end() || found->second.Incarnation != incarnation || sentAt < Duration(0) ||
        sentAt > LatestTime)
    {
        return Duration(0);
    }
    return std::max(arrivedAt - sentAt - found->second.Quickest(), Duration(0));
}

const std::vector<DelayMeter::Report> &DelayMeter::Take(std::size_t most, Duration now)
{
    _reports.clear();
    while (_reports.size() < most)
    {
        auto next = _peers.end();
        for (auto peer = _peers.begin(); peer != _peers.end(); ++peer)
        {
            if (!peer->second.Told && now <= peer->second.TellUntil &&
                (next == _peers.end() || peer->second.ToldAt < next->second.ToldAt))
            {
                next = peer;
            }
        }
        if (next == _peers.end())
        {
            break;
        }
        Peer &peer = next->second;
        peer.Told = true;
        peer.ToldAt = now;
        _reports.push_back({next->first, peer.Delay, std::max(now - peer.ArrivedAt, Duration(0))});
    }
    return _reports;
}

bool DelayMeter::HasReports(Duration now) const
{
    return std::any_of(_peers.begin(), _peers.end(),
                       [now](const auto &peer) { return !peer.second.Told && now <= peer.second.TellUntil; });
}

}  // namespace Rabit
