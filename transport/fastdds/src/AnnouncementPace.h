#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <set>

namespace Rabit::FastDds
{

// Decides when the announcements of our participant go. The vendor sends one four times for each participant
// that it discovers, to all: at a start of ten that is the greater part of what is said. One after it has
// heard the newcomer is enough. So they go in rounds: within a round each destination gets one, and what else
// the vendor sends waits for the next round, which is due if somebody was heard since this one began, and is
// not held otherwise: nobody has come who lacks it. Rounds that follow each other do so at doubling
// distances. By itself it asks for the first few rounds after the first, so that whoever lost that hears us
// soon. A pure state machine, not thread-safe.
class AnnouncementPace
{
public:
    using TimePoint = std::chrono::steady_clock::time_point;
    // A place to send to, and by which socket: the numbers are the caller's.
    using Destination = std::uint64_t;

    // The distance of the first two rounds, and the greatest. After a rest the distances begin anew.
    static constexpr std::chrono::milliseconds FirstGap{100};
    static constexpr std::chrono::milliseconds LongestGap{800};
    static constexpr std::chrono::milliseconds Rest{3200};
    // Rounds that it asks for after the first one, at distances that double: 0.1, 0.2 ... 3.2 s.
    static constexpr int InitialRounds = 6;
    // The same where other nodes learn of this one by its card: programs without a card need them alone.
    static constexpr int InitialRoundsWithCard = 2;
    static constexpr std::size_t MostDestinations = 4096;

    // The vendor announces us once a period by itself: no distance is longer than half of it.
    explicit AnnouncementPace(std::chrono::milliseconds period, bool hasCard = false);

    // Whether an announcement may go to this destination now. `content` differs if it says something else
    // than before: then it always may. `heard` is how many announcements of others have been heard.
    bool MayGo(Destination destination, std::uint64_t content, std::uint64_t heard, TimePoint now);

    // When all have to be told once more, if at all. Past that, each announcement may go.
    std::optional<TimePoint> Due() const;

private:
    void Begin(std::uint64_t content, std::uint64_t heard, TimePoint now);
    bool IsWanted(std::uint64_t heard, TimePoint now) const;

    const std::chrono::steady_clock::duration _longest;
    const std::chrono::steady_clock::duration _usual;  // after so long an announcement is one of the period's
    std::set<Destination> _told;                       // in this round
    std::optional<TimePoint> _begun;                   // this round
    std::uint64_t _content = 0;
    std::uint64_t _heard = 0;
    std::chrono::steady_clock::duration _gap{};  // to the next round
    bool _owed = false;
    int _initial;  // still to come
    std::chrono::steady_clock::duration _initialGap{};
    TimePoint _nextInitial{};
};

}  // namespace Rabit::FastDds
