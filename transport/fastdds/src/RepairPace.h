#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

namespace Rabit::FastDds
{

// Decides when what our discovery says of our endpoints goes to all who lack it. The vendor sends it to each
// who asks, at once: at a start of ten that is nine times each of ten. Here who asks first has it sent to
// all; who asks while that is under way gets it with the next round, together with all who did so. Rounds
// of the same content follow each other at doubling distances. A pure state machine, not thread-safe.
class RepairPace
{
public:
    using TimePoint = std::chrono::steady_clock::time_point;

    static constexpr std::chrono::milliseconds FirstGap{200};
    static constexpr std::chrono::milliseconds LongestGap{1600};
    // After which the distances begin anew.
    static constexpr std::chrono::milliseconds Rest{6400};
    static constexpr std::size_t MostContents = 512;

    // Somebody lacks this. True: it is to go to all, now. Else it is owed to all.
    bool MayGo(std::uint64_t content, TimePoint now);
    // When the next round of something that is owed is due.
    std::optional<TimePoint> Due() const;
    // What is to go to all now.
    std::vector<std::uint64_t> TakeDue(TimePoint now);
    std::size_t Size() const { return _rounds.size(); }

private:
    struct Round
    {
        TimePoint Begun;
        std::chrono::milliseconds Gap{FirstGap};
        bool Owed = false;
    };

    static void Begin(Round &round, TimePoint now);

    std::map<std::uint64_t, Round> _rounds;
};

}  // namespace Rabit::FastDds
