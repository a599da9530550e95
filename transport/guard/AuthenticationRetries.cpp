#include "guard/AuthenticationRetries.h"

#include <algorithm>
#include <utility>

namespace Rabit::Rtps
{

bool AuthenticationRetries::Announced(const GuidPrefix &peer, const Content &content, TimePoint now)
{
    if (!_peers.contains(peer))
    {
        MakeRoom();
    }
    Peer &known = _peers[peer];
    known.AnnouncedAt = now;
    if (!known.IsKnown)
    {
        known = Peer{.Known = content,
                     .IsKnown = true,
                     .Attempts = known.Attempts,
                     .ProgressAt = now,
                     .AnnouncedAt = now};
        return true;
    }
    if (known.Known.Digest != content.Digest)
    {
        known.IsContradicted = true;
        return false;
    }
    known.Known.Number = std::max(known.Known.Number, content.Number);
    return true;
}

bool AuthenticationRetries::Signs(const GuidPrefix &peer, const SignedContent &content)
{
    const auto found = _peers.find(peer);
    if (content.empty() || found == _peers.end() || !found->second.IsKnown)
    {
        return true;
    }
    Peer &known = found->second;
    const bool agrees = content == known.Known.Signed;
    known.IsContradicted = known.IsContradicted || !agrees;
    return agrees;
}

void AuthenticationRetries::Exchanged(const GuidPrefix &peer, Step step, bool isSent, TimePoint now)
{
    const auto found = _peers.find(peer);
    if (found == _peers.end() || step == Step::Control || step == Step::Rest)
    {
        return;
    }
    Peer &known = found->second;
    if (!isSent && (step == Step::Request || step == Step::Ask))
    {
        BeginsAnew(known, now);
    }
    if (step == Step::Keys && known.Keys < MostKeys)
    {
        ++known.Keys;
        known.ProgressAt = now;
    }
    const std::uint32_t bit = 1u << (2 * static_cast<unsigned>(step) + (isSent ? 1 : 0));
    if ((known.Steps & bit) == 0)
    {
        known.Steps |= bit;
        known.ProgressAt = now;
    }
}

void AuthenticationRetries::SaidGoodbye(const GuidPrefix &peer, TimePoint now)
{
    const auto found = _peers.find(peer);
    if (found != _peers.end())
    {
        BeginsAnew(found->second, now);
    }
}

void AuthenticationRetries::BeginsAnew(Peer &peer, TimePoint now)
{
    if (peer.IsKnown && peer.IsAuthenticated)
    {
        peer.IsAuthenticated = false;
        peer.IsToAsk = true;
        peer.Keys = MostKeys;  // datagrams of keys give it no more time
        peer.ProgressAt = now;
    }
}

void AuthenticationRetries::Gone(const GuidPrefix &peer)
{
    const auto found = _peers.find(peer);
    if (found != _peers.end())
    {
        found->second.IsKnown = false;
    }
}

std::optional<AuthenticationRetries::TimePoint> AuthenticationRetries::DueOf(const Peer &peer,
                                                                             Duration answerTime) const
{
    const bool isSilent = peer.AnnouncedAt <= peer.ProgressAt;
    if (!peer.IsKnown || peer.IsAuthenticated || (isSilent && !_forgetsSilent))
    {
        return std::nullopt;
    }
    constexpr int MostDoublings = 8;
    const bool hasBegun = peer.Steps != 0 || peer.IsContradicted;
    const Duration first = (hasBegun ? 1 : NotBegun) * std::max(_stalled, AnswerTimes * answerTime);
    return peer.ProgressAt +
           std::min<Duration>(first * (1 << std::min(peer.Attempts, MostDoublings)), Longest);
}

std::optional<AuthenticationRetries::TimePoint> AuthenticationRetries::Due(Duration answerTime) const
{
    std::optional<TimePoint> due;
    for (const auto &[prefix, peer] : _peers)
    {
        if (const auto of = peer.IsToAsk ? peer.ProgressAt : DueOf(peer, answerTime))
        {
            due = due ? std::min(*due, *of) : of;
        }
    }
    return due;
}

std::vector<GuidPrefix> AuthenticationRetries::TakeToAsk()
{
    std::vector<GuidPrefix> found;
    for (auto &[prefix, peer] : _peers)
    {
        if (std::exchange(peer.IsToAsk, false) && peer.IsKnown)
        {
            found.push_back(prefix);
        }
    }
    return found;
}

std::vector<GuidPrefix> AuthenticationRetries::Doubtful(TimePoint now, Duration answerTime) const
{
    std::vector<GuidPrefix> found;
    for (const auto &[prefix, peer] : _peers)
    {
        if (const auto due = DueOf(peer, answerTime); due && *due <= now)
        {
            found.push_back(prefix);
        }
    }
    return found;
}

void AuthenticationRetries::IsAuthenticated(const GuidPrefix &peer)
{
    const auto found = _peers.find(peer);
    if (found != _peers.end() && found->second.IsKnown)
    {
        found->second.IsAuthenticated = true;
        found->second.Attempts = 0;
    }
}

void AuthenticationRetries::IsWaiting(const GuidPrefix &peer, TimePoint now)
{
    const auto found = _peers.find(peer);
    if (found != _peers.end())
    {
        found->second.ProgressAt = now;
    }
}

std::int64_t AuthenticationRetries::Forget(const GuidPrefix &peer)
{
    Peer &known = _peers[peer];
    known.IsKnown = false;
    known.IsForgotten = true;
    ++known.Attempts;
    return known.Known.Number + 1;
}

bool AuthenticationRetries::WasForgotten(const GuidPrefix &peer) const
{
    const auto found = _peers.find(peer);
    return found != _peers.end() && found->second.IsForgotten;
}

void AuthenticationRetries::MakeRoom()
{
    if (_peers.size() >= Most)
    {
        _peers.erase(std::min_element(_peers.begin(), _peers.end(),
                                      [](const auto &one, const auto &other)
                                      { return one.second.AnnouncedAt < other.second.AnnouncedAt; }));
    }
}

}  // namespace Rabit::Rtps
