// Records the claims of announced participants, to reject those that cannot be true.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>

#include "guard/AbsentNumbers.h"
#include "guard/Claim.h"
#include "guard/PeerVoice.h"
#include "guard/RtpsMessage.h"
#include "guard/SampleNumbers.h"

namespace Rabit::Rtps
{

// A writer's numbers rise in steps. If a number jumped, the vendor would ignore all samples below it. So a
// jump is believed only if the writer's rate explains it, or the time for which it was not heard, or if
// several numbers in a row agree on it. Bounded: a full table of peers takes no new one until one in it was
// silent for a minute. A table that has doubled forgets all peers that were silent for five minutes.
// Not thread-safe.
class KnownPeers
{
public:
    using TimePoint = std::chrono::steady_clock::time_point;

    // A participant announced itself; `digest` is the hash of its addresses. Returns false if that is not
    // believed: the digest contradicts the known one, or there are too many peers. A participant may move:
    // other addresses are believed with the third announcement, if no announcement of the former ones came in
    // between nor for twice the announcement period. They are believed at once if the peer was not heard for
    // a minute.
    bool Announced(const GuidPrefix &peer, std::uint64_t digest, TimePoint now);
    // The announcement that was believed names these hosts, and came from `from` (PeerVoice.h).
    void IsAt(const GuidPrefix &peer, std::span<const HostAddress> hosts, const HostAddress &from);
    // True if the peer speaks from `from`, as far as is known.
    bool SpeaksFrom(const GuidPrefix &peer, const HostAddress &from) const;
    // True if discovery data attributed to `peer` should be processed. Data of unknown peers always is.
    bool Believes(const GuidPrefix &peer, const HostAddress &from, const PeerVoice::Saying &saying);
    // When the peer was last heard; empty: it was not announced, or is forgotten.
    std::optional<TimePoint> LastHeard(const GuidPrefix &peer) const;
    // Sets whether the peer, which must be known, listens to a multicast group for samples.
    void SetListensToGroup(const GuidPrefix &peer, bool yes) { _peers.at(peer).ListensToGroup = yes; }
    // True if a peer that speaks from there was heard since then, and all such peers listen to the group.
    bool GroupReaches(const HostAddress &host, TimePoint since) const;
    // True if the peer was announced; then notes that it is heard now.
    bool Hears(const GuidPrefix &peer, TimePoint now);

    // The vendor ignores announcements of a participant whose number it has seen. This returns numbers that
    // rise with the sender's, and also when it has moved: otherwise addresses forged before the true ones
    // were heard would stay. The peer must be known.
    std::int64_t AnnouncementOf(const GuidPrefix &peer, std::int64_t number);
    // The same for the peer's goodbye. It is always news, and so is the next announcement: a replay of the
    // peer's card has numbers of its own. RecentGoodbyes keeps back announcements that were held up.
    std::int64_t GoodbyeOf(const GuidPrefix &peer, std::int64_t number);

    // The peer, which must be known, announced a writer or a reader; `digest` is the hash of the
    // announcement. Returns false if it contradicts the known one. An endpoint that changes its QoS repeats
    // the announcement until it is received: the third identical one in a row is believed. Ledger.h limits
    // their number.
    bool EndpointAnnounced(const GuidPrefix &peer, EntityId endpoint, std::uint64_t digest,
                           bool isBestEffort = false);
    void EndpointGone(const GuidPrefix &peer, EntityId endpoint);
    // The peer said goodbye: all its endpoints are gone.
    void EndpointsGone(const GuidPrefix &peer);
    // The vendor was told that the peer left. Its next announcement is believed, whatever it says.
    void Ended(const GuidPrefix &peer);
    bool HasWriter(const GuidPrefix &peer, EntityId writer) const;

    // True if an announced writer can have reached this number, which is then noted. The first number of a
    // writer may be up to four million.
    bool Reaches(const GuidPrefix &peer, EntityId writer, std::int64_t number, TimePoint now);
    // Number under which to give the vendor a believed sample, or a fragment of one (SampleNumbers.h);
    // differs from `number` only for best-effort writers. The writer must have been announced.
    std::int64_t NumberOf(const GuidPrefix &peer, EntityId writer, std::int64_t number, std::uint64_t stamp,
                          TimePoint now);
    // The numbers of an announced writer that the vendor may be told to be absent. Null: it was not
    // announced.
    AbsentNumbers *Absent(const GuidPrefix &peer, EntityId writer);
    // True if an announced writer can know the state of the samples up to this number.
    bool CanKnowOf(const GuidPrefix &peer, EntityId writer, std::int64_t number) const;

    // Heartbeats are told from their repeats by a count that must rise: one forged high count would silence
    // all honest heartbeats after it. This returns a count of our own, which rises by one whenever `count`
    // differs from the one before. The writer must have been announced.
    std::uint32_t CountOf(const GuidPrefix &peer, EntityId writer, std::uint32_t count);

    std::size_t Size() const { return _peers.size(); }

private:
    static constexpr std::size_t FewestToSweep = 16;

    struct Numbers
    {
        Claim<std::uint64_t> Endpoint;
        std::int64_t Highest = 0;  // 0: no number was heard yet
        TimePoint Said{};          // when a number was last believed, the highest or not
        // Its rate: number of advances per second, and in the current second. The width of the advances does
        // not count: one forged number after the other would widen it.
        std::int64_t Pace = 0;
        std::int64_t Steps = 0;
        TimePoint Began{};
        // The last number that was refused, and how many in a row agreed.
        std::int64_t Suspect = 0;
        int Agreeing = 0;
        std::uint32_t TheirCount = 0;
        std::uint32_t OurCount = 0;
        bool IsBestEffort = false;
        SampleNumbers Samples;
        AbsentNumbers Absent;
    };
    struct Peer
    {
        Claim<std::uint64_t> Place;
        bool HasEnded = false;  // and was not announced since
        PeerVoice Speaks;
        bool ListensToGroup = false;
        TimePoint Placed{};                  // when its addresses were last announced
        std::chrono::milliseconds Period{};  // interval at which they are announced
        TimePoint Heard{};
        bool NextIsNews = false;  // its next announcement, whatever its number
        std::int64_t Theirs = 0;  // the highest number of its announcements
        std::int64_t Ours = 0;
        std::map<EntityId, Numbers> Writers;
        std::map<EntityId, Claim<std::uint64_t>> Readers;
    };

    bool MakeRoom(TimePoint now);
    void ForgetSilent(TimePoint now);
    static bool IsPlausible(Numbers &numbers, std::int64_t number, TimePoint now);
    static void Move(Numbers &numbers, std::int64_t number, TimePoint now);

    std::map<GuidPrefix, Peer> _peers;
    std::size_t _sweepAt = FewestToSweep;  // number of peers
    // The highest numbers given out, including those for forgotten peers and writers.
    std::int64_t _highestAnnouncement = 0;
    std::uint32_t _highestCount = 0;
};

}  // namespace Rabit::Rtps
