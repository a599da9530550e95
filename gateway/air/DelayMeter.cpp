#include "air/DelayMeter.h"

#include <algorithm>

namespace Rabit
{

void DelayMeter::Peer::Begin(std::uint64_t incarnation, Duration offset, Duration now)
{
    *this = Peer{};
    Incarnation = incarnation;
    Least.fill(None);
    Least.front() = Quickest = offset;
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
    BucketEnd = std::max(BucketEnd, now);
    Quickest = *std::min_element(Least.begin(), Least.end());
}

DelayMeter::Peer &DelayMeter::PeerOf(std::string_view node)
{
    if (_last != _peers.end() && _last->first == node)
    {
        return _last->second;
    }
    _last = _peers.find(node);
    if (_last != _peers.end())
    {
        return _last->second;
    }
    if (_peers.size() == MostPeers)
    {
        _peers.erase(std::min_element(_peers.begin(), _peers.end(),
                                      [](const auto &a, const auto &b)
                                      { return a.second.ArrivedAt < b.second.ArrivedAt; }));
    }
    _last = _peers.emplace(node, Peer{}).first;
    return _last->second;
}

bool DelayMeter::Heard(std::string_view node, std::uint64_t incarnation, Duration sentAt, Duration arrivedAt)
{
    if (sentAt < Duration(0) || sentAt > LatestTime)
    {
        return false;
    }
    Peer &peer = PeerOf(node);
    const Duration offset = arrivedAt - sentAt;
    if (peer.Incarnation != incarnation)
    {
        peer.Begin(incarnation, offset, arrivedAt);
    }
    if (arrivedAt >= peer.BucketEnd)
    {
        peer.Turn(arrivedAt);
    }
    if (offset < peer.Least.front())
    {
        peer.Least.front() = offset;
        peer.Quickest = std::min(peer.Quickest, offset);
    }
    if (sentAt < peer.SentAt)
    {
        return false;  // overtaken
    }
    if (offset - peer.Quickest > Longest)
    {
        peer.Begin(incarnation, offset, arrivedAt);
    }
    peer.SentAt = sentAt;
    peer.ArrivedAt = arrivedAt;
    peer.Delay = offset - peer.Quickest;
    peer.Told = false;
    if (peer.Delay > Late)
    {
        peer.TellUntil = arrivedAt + Echo;
    }
    return arrivedAt <= peer.TellUntil;
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
        _reports.push_back({&next->first, peer.Delay, std::max(now - peer.ArrivedAt, Duration(0))});
    }
    return _reports;
}

}  // namespace Rabit
