#include "common/RejoinDecision.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace Rabit
{

namespace
{

bool Has(const std::vector<HostNetwork> &networks, const HostNetwork &wanted)
{
    return std::any_of(networks.begin(), networks.end(),
                       [&](const HostNetwork &network) { return network.IsSame(wanted); });
}

// True if the address is present: datagrams to it arrive, at least from this host.
bool IsPresent(const std::vector<HostNetwork> &host, const HostNetwork &wanted)
{
    return std::any_of(host.begin(), host.end(),
                       [&](const HostNetwork &network) { return network.IsSame(wanted) && network.Up; });
}

bool IsRunning(const std::vector<HostNetwork> &host, const HostNetwork &wanted)
{
    return std::any_of(host.begin(), host.end(),
                       [&](const HostNetwork &network) { return network.IsSame(wanted) && network.Running; });
}

bool Names(const PeerPlace &peer, const std::string &address)
{
    return std::find(peer.begin(), peer.end(), address) != peer.end();
}

// The peer's addresses that are on other hosts, as far as that can be told. Container bridges often have the
// same address on all hosts.
PeerPlace Elsewhere(const PeerPlace &peer, const std::vector<HostNetwork> &host,
                    const std::vector<HostNetwork> &with)
{
    PeerPlace elsewhere;
    for (const std::string &address : peer)
    {
        const auto isOwn = [&](const HostNetwork &network)
        { return network.Address == address || (network.Loopback && network.Contains(address)); };
        if (std::none_of(host.begin(), host.end(), isOwn) && std::none_of(with.begin(), with.end(), isOwn))
        {
            elsewhere.push_back(address);
        }
    }
    return elsewhere;
}

bool IsOn(const PeerPlace &addresses, const std::vector<HostNetwork> &networks)
{
    return std::any_of(networks.begin(), networks.end(),
                       [&](const HostNetwork &network)
                       {
                           return std::any_of(addresses.begin(), addresses.end(),
                                              [&](const std::string &address)
                                              { return network.Contains(address); });
                       });
}

}  // namespace

RejoinDecision::Verdict RejoinDecision::Look(TimePoint now, const View &view)
{
    Follow(now, view);
    Verdict verdict;
    const auto consider = [&](TimePoint due, const std::string &why)
    {
        if (due <= now && !verdict.Join)
        {
            verdict.Join = true;
            verdict.Why = why;
        }
        verdict.Again = std::min(due, verdict.Again.value_or(due));
    };
    if (!_isJoined)
    {
        if (!view.Usable.empty())
        {
            consider(_retryAt.value_or(now), "there is a network");
        }
        return verdict;
    }
    for (const HostNetwork &network : view.Usable)
    {
        if (const auto due = Has(_with, network) ? std::nullopt : DueFor(network))
        {
            consider(Spaced(*due), Describe(network) + " has come");
        }
    }
    for (const HostNetwork &network : _with)
    {
        const auto gone = _gone.find(KeyOf(network));
        if (gone != _gone.end() && IsMissed(network, view))
        {
            consider(Spaced(gone->second + _times.LostFor), Describe(network) + " is gone");
        }
        if (gone != _gone.end() && IsRunning(view.Host, network) && !network.Loopback && !view.Usable.empty())
        {
            consider(Spaced(now), Describe(network) + " is not to be used");
        }
    }
    if (view.PeersResolved && !view.Usable.empty())
    {
        consider(Spaced(now), "a peer has got an address");
    }
    return verdict;
}

void RejoinDecision::Joined(TimePoint now, std::vector<HostNetwork> with)
{
    _isJoined = true;
    _with = std::move(with);
    _lastJoin = now;
    _retryAt.reset();
    _retry.Reset();
    _gone.clear();
    _allGone.reset();
}

void RejoinDecision::Failed(TimePoint now)
{
    _isJoined = false;
    _with.clear();
    _gone.clear();
    _allGone.reset();
    _retryAt = now + _retry.Next();
}

void RejoinDecision::Follow(TimePoint now, const View &view)
{
    for (const HostNetwork &network : view.Usable)
    {
        _usable.try_emplace(KeyOf(network), Seen{network.Interface, now});
    }
    std::erase_if(_usable,
                  [&](const auto &entry)
                  {
                      const auto &key = entry.first;
                      const auto &seen = entry.second;
                      const bool stays =
                          std::any_of(view.Usable.begin(), view.Usable.end(),
                                      [&](const HostNetwork &network) { return KeyOf(network) == key; });
                      if (!stays)
                      {
                          _vanished[seen.Interface].push_back(now);
                      }
                      return !stays;
                  });
    for (auto &[interface, times] : _vanished)
    {
        while (!times.empty() && times.front() + _times.Memory < now)
        {
            times.pop_front();
        }
    }
    std::erase_if(_vanished, [](const auto &entry) { return entry.second.empty(); });
    bool present = false;
    for (const HostNetwork &network : _with)
    {
        present = present || IsPresent(view.Host, network);
        if (Has(view.Usable, network))
        {
            _gone.erase(KeyOf(network));
        }
        else
        {
            _gone.try_emplace(KeyOf(network), now);
        }
    }
    if (present || !_isJoined)
    {
        _allGone.reset();
    }
    else if (!_allGone)
    {
        _allGone = now;
    }
}

std::chrono::milliseconds RejoinDecision::SettleOf(const std::string &interface) const
{
    const auto vanished = _vanished.find(interface);
    auto settle = _times.Settle;
    for (std::size_t i = 0; vanished != _vanished.end() && i < vanished->second.size(); ++i)
    {
        settle = std::min(2 * settle, _times.LongestSettle);
    }
    return settle;
}

std::optional<RejoinDecision::TimePoint> RejoinDecision::DueFor(const HostNetwork &network) const
{
    if (network.Loopback)
    {
        return _allGone ? std::optional(*_allGone + _times.LostFor) : std::nullopt;
    }
    return _usable.at(KeyOf(network)).Since + SettleOf(network.Interface);
}

bool RejoinDecision::IsMissed(const HostNetwork &gone, const View &view) const
{
    std::vector<HostNetwork> rest;
    for (const HostNetwork &network : _with)
    {
        if (Has(view.Usable, network))
        {
            rest.push_back(network);
        }
    }
    const auto mayStillSendThere = [&](const PeerPlace &peer)
    {
        const PeerPlace elsewhere = Elsewhere(peer, view.Host, _with);
        const bool onBoth = IsOn(elsewhere, {gone}) && IsOn(elsewhere, rest);
        const bool isRouted = !elsewhere.empty() && !IsOn(elsewhere, _with);
        // The peer is another process of this host.
        const bool isLocal =
            Names(peer, gone.Address) && !IsPresent(view.Host, gone) &&
            std::any_of(rest.begin(), rest.end(),
                        [&](const HostNetwork &network) { return Names(peer, network.Address); });
        return onBoth || isRouted || isLocal;
    };
    return !rest.empty() && std::any_of(view.Peers.begin(), view.Peers.end(), mayStillSendThere);
}

RejoinDecision::TimePoint RejoinDecision::Spaced(TimePoint due) const
{
    return _lastJoin ? std::max(due, *_lastJoin + _times.Spacing) : due;
}

}  // namespace Rabit
