#include "guard/KnownPeers.h"

#include <algorithm>
#include <utility>

#include "guard/DeliveryCheck.h"

namespace Rabit::Rtps
{

namespace
{

constexpr std::size_t MostPeers = 1024;
// Longer than the announcement periods and leases in use.
constexpr std::chrono::seconds Forgotten{60};
// While there is room, peers are remembered for longer: a returning peer is heard at once.
constexpr std::chrono::minutes LongSilence{5};
// Bounds of the announcement period of a participant, whatever was measured: forged repeats would shorten it,
// and an outage would lengthen it.
constexpr std::chrono::milliseconds ShortestPeriod{1000};
constexpr std::chrono::milliseconds LongestPeriod{15'000};
// Largest first number of a writer that is believed at once. A larger one is believed when enough agree.
constexpr std::int64_t LargestFirst = std::int64_t{1} << 22;
// After this time without a number of a writer, more samples may have been lost than its rate explains.
constexpr std::chrono::seconds Silence{2};
// Samples of a reliable writer that may be lost at once, whatever its rate.
constexpr std::int64_t LargestStep = 16;
// The same for a best-effort writer. It may write most of its samples to other nodes alone, so that none of
// those numbers is seen here. A forged number up to here costs the writer two samples (SampleNumbers).
constexpr std::int64_t LargestBestEffortStep = 1'000'000;
// Samples that may have been lost of a writer that was silent for Silence, whatever its rate: per second, and
// in all. Multicast announcements go on while everything else is lost (an address that was away, a link in
// one direction), so such a gap is ordinary. A writer of two samples a second must not be refused until
// enough numbers agree. The vendor records each number in a gap, and copes with this many.
constexpr std::int64_t LostInASecond = 1000;
constexpr std::int64_t LargestLoss = 50'000;
// They need no announcement.
constexpr EntityId BuiltinWriters[] = {ParticipantWriter, PublicationsWriter, SubscriptionsWriter,
                                       LivelinessWriter};
// Number of agreeing numbers in a row. Heartbeats come every 20 ms, so they need 160 ms.
constexpr int EnoughAgreeing = 8;

}  // namespace

bool KnownPeers::Announced(const GuidPrefix &peer, std::uint64_t digest, TimePoint now)
{
    const auto found = _peers.find(peer);
    if (found != _peers.end())
    {
        Peer &known = found->second;
        const auto since = std::chrono::duration_cast<std::chrono::milliseconds>(now - known.Placed);
        if (known.Place.IsAccepted(digest))
        {
            known.Period = std::clamp(std::max(since, known.Period / 2), ShortestPeriod, LongestPeriod);
        }
        else if (!known.HasEnded)
        {
            const bool repeated = known.Place.IsRepeated(digest);
            if (now - known.Heard < Forgotten && (!repeated || since < 2 * known.Period))
            {
                return false;
            }
            known.NextIsNews = true;
        }
        known.Place = Claim(digest);
        known.HasEnded = false;
        known.Placed = now;
        known.Heard = now;
        for (const EntityId writer : BuiltinWriters)
        {
            known.Writers[writer].Absent.Announced();
        }
        return true;
    }
    if (_peers.size() >= _sweepAt)
    {
        ForgetSilent(now);
    }
    if (_peers.size() >= MostPeers && !MakeRoom(now))
    {
        return false;
    }
    Peer &added = _peers[peer];
    added.Place = Claim(digest);
    added.Placed = now;
    added.Period = ShortestPeriod;
    added.Heard = now;
    for (const EntityId writer : BuiltinWriters)
    {
        added.Writers[writer];
    }
    return true;
}

void KnownPeers::IsAt(const GuidPrefix &peer, std::span<const HostAddress> hosts, const HostAddress &from)
{
    _peers.at(peer).Speaks.Announced(hosts, from);
}

bool KnownPeers::SpeaksFrom(const GuidPrefix &peer, const HostAddress &from) const
{
    const auto found = _peers.find(peer);
    return found == _peers.end() || found->second.Speaks.IsAt(from);
}

bool KnownPeers::Believes(const GuidPrefix &peer, const HostAddress &from, const PeerVoice::Saying &saying)
{
    const auto found = _peers.find(peer);
    return found == _peers.end() || found->second.Speaks.Believes(from, saying);
}

std::int64_t KnownPeers::AnnouncementOf(const GuidPrefix &peer, std::int64_t number)
{
    Peer &known = _peers.at(peer);
    if (known.Ours == 0)
    {
        known.Ours = std::max(number, _highestAnnouncement + 1);
        known.Theirs = number;
    }
    else if (known.NextIsNews || number > known.Theirs)
    {
        ++known.Ours;
        known.Theirs = number;
    }
    known.NextIsNews = false;
    return known.Ours;
}

std::int64_t KnownPeers::GoodbyeOf(const GuidPrefix &peer, std::int64_t number)
{
    _peers.at(peer).NextIsNews = true;
    const std::int64_t ours = AnnouncementOf(peer, number);
    _peers.at(peer).NextIsNews = true;
    return ours;
}

bool KnownPeers::MakeRoom(TimePoint now)
{
    const auto oldest =
        std::min_element(_peers.begin(), _peers.end(),
                         [](const auto &a, const auto &b) { return a.second.Heard < b.second.Heard; });
    if (now - oldest->second.Heard < Forgotten)
    {
        return false;
    }
    _highestAnnouncement = std::max(_highestAnnouncement, oldest->second.Ours);
    _peers.erase(oldest);
    return true;
}

// Needed because a node that restarts again and again is a new peer each time.
void KnownPeers::ForgetSilent(TimePoint now)
{
    std::erase_if(_peers,
                  [this, now](const auto &peer)
                  {
                      const bool isSilent = now - peer.second.Heard >= LongSilence;
                      _highestAnnouncement =
                          isSilent ? std::max(_highestAnnouncement, peer.second.Ours) : _highestAnnouncement;
                      return isSilent;
                  });
    _sweepAt = std::max(FewestToSweep, 2 * _peers.size());
}

std::optional<KnownPeers::TimePoint> KnownPeers::LastHeard(const GuidPrefix &peer) const
{
    const auto found = _peers.find(peer);
    return found == _peers.end() ? std::nullopt : std::optional(found->second.Heard);
}

bool KnownPeers::GroupReaches(const HostAddress &host, TimePoint since) const
{
    bool any = false;
    for (const auto &[prefix, peer] : _peers)
    {
        if (peer.Heard >= since && peer.Speaks.IsAt(host))
        {
            any = true;
            if (!peer.ListensToGroup)
            {
                return false;
            }
        }
    }
    return any;
}

bool KnownPeers::Hears(const GuidPrefix &peer, TimePoint now)
{
    const auto found = _peers.find(peer);
    if (found == _peers.end())
    {
        return false;
    }
    found->second.Heard = now;
    return true;
}

bool KnownPeers::EndpointAnnounced(const GuidPrefix &peer, EntityId endpoint, std::uint64_t digest,
                                   bool isBestEffort)
{
    Peer &known = _peers.at(peer);
    if (!IsWriter(endpoint))
    {
        return known.Readers.try_emplace(endpoint, digest).first->second.Accepts(digest);
    }
    const auto [at, isNew] = known.Writers.try_emplace(endpoint);
    Numbers &writer = at->second;
    if (isNew)
    {
        writer.Endpoint = Claim(digest);
        writer.IsBestEffort = isBestEffort;
        return true;
    }
    const bool agrees = writer.Endpoint.Accepts(digest);
    if (agrees)
    {
        writer.IsBestEffort = isBestEffort;
        writer.Absent.Announced();
    }
    return agrees;
}

void KnownPeers::EndpointGone(const GuidPrefix &peer, EntityId endpoint)
{
    const auto found = _peers.find(peer);
    if (found != _peers.end() && !IsBuiltin(endpoint))
    {
        found->second.Writers.erase(endpoint);
        found->second.Readers.erase(endpoint);
    }
}

void KnownPeers::EndpointsGone(const GuidPrefix &peer)
{
    const auto found = _peers.find(peer);
    if (found != _peers.end())
    {
        std::erase_if(found->second.Writers, [](const auto &entry) { return !IsBuiltin(entry.first); });
        found->second.Readers.clear();
    }
}

void KnownPeers::Ended(const GuidPrefix &peer)
{
    EndpointsGone(peer);
    const auto found = _peers.find(peer);
    if (found != _peers.end())
    {
        found->second.HasEnded = true;
    }
}

bool KnownPeers::HasWriter(const GuidPrefix &peer, EntityId writer) const
{
    return _peers.at(peer).Writers.count(writer) > 0;
}

bool KnownPeers::Reaches(const GuidPrefix &peer, EntityId writer, std::int64_t number, TimePoint now)
{
    auto &writers = _peers.at(peer).Writers;
    const auto found = writers.find(writer);
    if (found == writers.end())
    {
        return false;
    }
    Numbers &numbers = found->second;
    if (number > numbers.Highest && !IsPlausible(numbers, number, now))
    {
        return false;
    }
    numbers.Agreeing = 0;
    if (number > numbers.Highest)
    {
        Move(numbers, number, now);
    }
    // A writer heard at or below its highest number has not gone far since, even if that number was forged.
    numbers.Said = now;
    return true;
}

bool KnownPeers::IsPlausible(Numbers &numbers, std::int64_t number, TimePoint now)
{
    if (numbers.Highest == 0 && number <= LargestFirst)
    {
        return true;
    }
    const std::int64_t step = numbers.IsBestEffort ? LargestBestEffortStep : LargestStep;
    const auto elapsed = std::chrono::duration_cast<std::chrono::milliseconds>(now - numbers.Said).count();
    const std::int64_t lost =
        now - numbers.Said >= Silence ? std::min(LostInASecond * elapsed / 1000, LargestLoss) : 0;
    if (numbers.Highest > 0 &&
        number - numbers.Highest <= step + std::max(lost, 2 * numbers.Pace * elapsed / 1000))
    {
        return true;
    }
    const bool agrees = numbers.Agreeing > 0 && number >= numbers.Suspect &&
                        number - numbers.Suspect <= LargestStep + numbers.Pace;
    numbers.Agreeing = agrees ? numbers.Agreeing + 1 : 1;
    numbers.Suspect = number;
    return numbers.Agreeing >= EnoughAgreeing;
}

void KnownPeers::Move(Numbers &numbers, std::int64_t number, TimePoint now)
{
    constexpr std::chrono::seconds Window{1};
    if (numbers.Highest == 0)
    {
        numbers.Pace = 0;
        numbers.Steps = 0;
        numbers.Began = now;
    }
    ++numbers.Steps;
    const auto elapsed = std::chrono::duration_cast<std::chrono::milliseconds>(now - numbers.Began);
    if (elapsed >= Window)
    {
        // A pause does not make a fast writer slow at once.
        numbers.Pace = std::max(1000 * numbers.Steps / elapsed.count(), numbers.Pace / 2);
        numbers.Steps = 0;
        numbers.Began = now;
    }
    numbers.Highest = number;
}

std::int64_t KnownPeers::NumberOf(const GuidPrefix &peer, EntityId writer, std::int64_t number,
                                  std::uint64_t stamp, TimePoint now)
{
    Numbers &numbers = _peers.at(peer).Writers.at(writer);
    if (!numbers.IsBestEffort)
    {
        return number;
    }
    const std::int64_t given = numbers.Samples.Of(number, stamp, now);
    numbers.Highest = numbers.Samples.Highest();
    return given;
}

AbsentNumbers *KnownPeers::Absent(const GuidPrefix &peer, EntityId writer)
{
    const auto found = _peers.find(peer);
    if (found == _peers.end())
    {
        return nullptr;
    }
    const auto numbers = found->second.Writers.find(writer);
    return numbers == found->second.Writers.end() ? nullptr : &numbers->second.Absent;
}

bool KnownPeers::CanKnowOf(const GuidPrefix &peer, EntityId writer, std::int64_t number) const
{
    const auto &writers = _peers.at(peer).Writers;
    const auto found = writers.find(writer);
    return found != writers.end() && number <= found->second.Highest + LargestStep;
}

std::uint32_t KnownPeers::CountOf(const GuidPrefix &peer, EntityId writer, std::uint32_t count)
{
    Numbers &numbers = _peers.at(peer).Writers.at(writer);
    if (numbers.OurCount == 0)
    {
        // Above all counts that the vendor can have been given for the writer, in case it was forgotten.
        numbers.OurCount = _highestCount + 1;
    }
    else if (count != numbers.TheirCount)
    {
        ++numbers.OurCount;
    }
    numbers.TheirCount = count;
    _highestCount = std::max(_highestCount, numbers.OurCount);
    return numbers.OurCount;
}

}  // namespace Rabit::Rtps
