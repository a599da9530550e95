// What the participants that were announced have said so far, to tell what they cannot say next.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>

#include "guard/PeerVoice.h"
#include "guard/RtpsMessage.h"
#include "guard/SampleNumbers.h"

namespace Rabit::Rtps
{

// A writer's numbers rise in steps. One that jumped would have the vendor walk through millions of samples
// that never were, and pass over all that come until they reach that number. So a jump is believed if the
// writer's pace explains it, or the time for which it was not heard, or if several numbers in a row agree on
// it with none in between that does not.
// Bounded: a full table of peers takes no new one until one in it was silent for a minute. A table that has
// doubled forgets all peers that were silent for five. A full table of writers forgets one. Not thread-safe.
class KnownPeers
{
public:
    using TimePoint = std::chrono::steady_clock::time_point;

    // A participant announced itself; `digest` is of where it is heard. False if that is not to be believed:
    // it said otherwise before, or there are too many. A participant may move: another place is believed when
    // it is said for the third time, with no word of the former one in between nor for twice as long as there
    // was between two such words.
    bool Announced(const GuidPrefix &peer, std::uint64_t digest, TimePoint now);
    // What was believed also says that it is at these hosts, and came from `from` (PeerVoice.h).
    void IsAt(const GuidPrefix &peer, std::span<const HostAddress> hosts, const HostAddress &from);
    // Whether it speaks from there, as far as is known.
    bool SpeaksFrom(const GuidPrefix &peer, const HostAddress &from) const;
    // Whether what the peer is to have said of discovery is to be looked at. What is said in the name of who
    // is not known is.
    bool Believes(const GuidPrefix &peer, const HostAddress &from, const PeerVoice::Saying &saying);
    // When the peer was heard last; empty: it was not announced, or is forgotten.
    std::optional<TimePoint> LastHeard(const GuidPrefix &peer) const;
    // Sets whether the peer, which must be known, listens to a multicast group for samples.
    void SetListensToGroup(const GuidPrefix &peer, bool yes) { _peers.at(peer).ListensToGroup = yes; }
    // True if a peer that speaks from there was heard since then, and all such peers listen to the group.
    bool GroupReaches(const HostAddress &host, TimePoint since) const;
    // Whether the peer was announced; if so, it is heard of at this moment.
    bool Hears(const GuidPrefix &peer, TimePoint now);

    // The vendor passes over announcements of a participant whose number it has seen. This gives them numbers
    // that rise with the sender's, and when it has moved: else a place that was forged before the true one
    // was heard would stay. The peer must be known.
    std::int64_t AnnouncementOf(const GuidPrefix &peer, std::int64_t number);

    // The peer, which must be known, announced a writer or a reader; `digest` is of what it says of it. False
    // if it said otherwise before; but it may change its mind, and then sends its announcement until it is
    // received: that is believed with the third in a row. Of too many writers the one that was silent
    // for longest is forgotten.
    bool EndpointAnnounced(const GuidPrefix &peer, EntityId endpoint, std::uint64_t digest,
                           bool isBestEffort = false);
    bool HasWriter(const GuidPrefix &peer, EntityId writer) const;

    // Whether a writer that was announced can be at this number. If so, it is there. What a writer says first
    // may be any number up to four million.
    bool Reaches(const GuidPrefix &peer, EntityId writer, std::int64_t number, TimePoint now);
    // Under which number the vendor is to be given a sample, or a fragment of one, that was believed
    // (SampleNumbers.h); its own but for writers that are best effort. The writer must have been announced.
    std::int64_t NumberOf(const GuidPrefix &peer, EntityId writer, std::int64_t number, std::uint64_t stamp,
                          TimePoint now);
    // Whether a writer that was announced can know what became of the samples up to this number.
    bool CanKnowOf(const GuidPrefix &peer, EntityId writer, std::int64_t number) const;

    // Heartbeats are told from their repeats by a count that must rise, and one that was forged high would
    // silence all honest ones after it. This gives each an own count, which rises by one with each that is
    // not a repeat of the one before. The writer must have been announced.
    std::uint32_t CountOf(const GuidPrefix &peer, EntityId writer, std::uint32_t count);

    std::size_t Size() const { return _peers.size(); }

private:
    static constexpr std::size_t FewestToSweep = 16;

    // What was said of something, and what was said otherwise since: how many times in a row.
    struct Word
    {
        std::uint64_t Digest = 0;
        std::uint64_t Other = 0;
        int Times = 0;
    };
    struct Numbers
    {
        Word Endpoint;
        std::int64_t Highest = 0;  // 0: nothing was heard of it
        TimePoint Said{};          // when it was heard at a number that was believed, the highest or not
        // Its pace: how often in a second it went on, and how often in the second under way. Not how far,
        // which one forged number after the other would widen.
        std::int64_t Pace = 0;
        std::int64_t Steps = 0;
        TimePoint Began{};
        // The last number that was not believed, and how many in a row agreed.
        std::int64_t Suspect = 0;
        int Agreeing = 0;
        std::uint32_t TheirCount = 0;
        std::uint32_t OurCount = 0;
        bool IsBestEffort = false;
        SampleNumbers Samples;
    };
    struct Peer
    {
        Word Place;
        PeerVoice Speaks;
        bool ListensToGroup = false;
        bool IsNewThere = true;              // since IsAt
        TimePoint Placed{};                  // when it was last said to be there
        std::chrono::milliseconds Period{};  // in which that is said again
        TimePoint Heard{};
        bool HasMoved = false;    // since its last announcement
        std::int64_t Theirs = 0;  // the highest number of its announcements
        std::int64_t Ours = 0;
        std::map<EntityId, Numbers> Writers;
        std::map<EntityId, Word> Readers;
    };

    bool MakeRoom(TimePoint now);
    void ForgetSilent(TimePoint now);
    // Whether this is what was said before; if not, whether it was said often enough.
    static bool IsKnown(Word &word, std::uint64_t digest);
    static bool IsRepeated(Word &word, std::uint64_t digest);
    // Both; what was said often enough is known from then on.
    static bool Agrees(Word &word, std::uint64_t digest);
    static bool IsPlausible(Numbers &numbers, std::int64_t number, TimePoint now);
    static void Move(Numbers &numbers, std::int64_t number, TimePoint now);

    std::map<GuidPrefix, Peer> _peers;
    std::size_t _sweepAt = FewestToSweep;  // so many peers
    // Of all given, for peers and writers that were forgotten.
    std::int64_t _highestAnnouncement = 0;
    std::uint32_t _highestCount = 0;
};

}  // namespace Rabit::Rtps
