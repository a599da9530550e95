#pragma once

#include <chrono>

namespace Rabit::Simulated
{

// When a participant announces itself to all, as with our real backends: some times at first, at distances
// that double; then once a period; and soon after somebody has come, for all who have come meanwhile. Rounds
// that follow each other do so at doubling distances. A pure state machine.
class AnnouncementRounds
{
public:
    using Time = std::chrono::nanoseconds;

    static constexpr Time FirstGap = std::chrono::milliseconds(100);
    static constexpr Time LongestGap = std::chrono::milliseconds(800);
    static constexpr Time Rest = std::chrono::milliseconds(3200);  // after it the distances begin anew
    static constexpr int InitialRounds = 6;

    explicit AnnouncementRounds(Time period) : _period(period) {}

    void OnAnnounced(Time now);
    // Somebody has come, or has not heard us yet.
    void Owe() { _owed = true; }
    // The next one. May be in the past.
    Time Next() const;

private:
    const Time _period;
    bool _begun = false;
    Time _last{0};
    Time _gap{0};
    bool _owed = false;
    int _initial = InitialRounds;  // still to come
    Time _initialGap = FirstGap;
    Time _nextInitial{0};
};

}  // namespace Rabit::Simulated
