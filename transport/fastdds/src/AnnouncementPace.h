#pragma once

#include <rabit/base/Backoff.h>

#include <chrono>
#include <cstdint>
#include <optional>
#include <set>

namespace Rabit::FastDds
{

// Decides when announcements of our participant go. The vendor sends one to all, four times for each
// participant that it discovers: the greater part of the traffic when ten nodes start. One announcement after
// the newcomer was heard is enough. So announcements go in rounds: within a round each destination gets one,
// and further ones wait for the next round. That round is due if a participant was heard since this one
// began. Otherwise nobody lacks the announcement, and it is dropped. Intervals between successive rounds
// double. The class also requests the first few rounds by itself, so that a peer that lost the first
// announcement hears us soon. A pure state machine, not thread-safe.
class AnnouncementPace
{
public:
    using TimePoint = std::chrono::steady_clock::time_point;
    // Number of an address and the socket that sends to it, chosen by the caller.
    using Destination = std::uint64_t;

    // First and longest interval between two rounds. After Rest without a round the intervals start anew.
    static constexpr std::chrono::milliseconds FirstGap{100};
    static constexpr std::chrono::milliseconds LongestGap{800};
    static constexpr std::chrono::milliseconds Rest{3200};
    // Rounds that it requests after the first one, at doubling intervals: 0.1, 0.2 ... 3.2 s.
    static constexpr int InitialRounds = 6;
    // The same where other nodes learn of this one by its card: at 2 and 6 s. Only programs without a card
    // need them, and a crowd that starts has other things to send.
    static constexpr std::chrono::milliseconds InitialGapWithCard{2000};
    static constexpr int InitialRoundsWithCard = 2;
    static constexpr std::size_t MostDestinations = 4096;

    // `period`: the vendor's announcement period. No interval is longer than half of it.
    explicit AnnouncementPace(std::chrono::milliseconds period, bool hasCard = false);

    // True if an announcement may go to this destination now. `content` tells announcements apart: a changed
    // one may always go. `heard`: number of other participants' announcements heard so far.
    bool MayGo(Destination destination, std::uint64_t content, std::uint64_t heard, TimePoint now);

    // When all destinations need another announcement, if at all. From that time each announcement may go.
    std::optional<TimePoint> Due() const;

private:
    void Begin(std::uint64_t content, std::uint64_t heard, TimePoint now);
    bool IsWanted(std::uint64_t heard, TimePoint now) const;

    const std::chrono::steady_clock::duration _firstInitial;
    const std::chrono::steady_clock::duration _usual;  // after this, an announcement is a periodic one
    std::set<Destination> _told;                       // in this round
    std::optional<TimePoint> _begun;                   // this round
    std::uint64_t _content = 0;
    std::uint64_t _heard = 0;
    Backoff _gap;  // to the next round
    bool _owed = false;
    BackoffTimer<TimePoint> _initial;  // the first rounds, which it requests by itself
};

}  // namespace Rabit::FastDds
