#pragma once

#include <rabit/base/Backoff.h>

#include <chrono>
#include <optional>

namespace Rabit::Cyclone
{

// Decides when our participant is announced to all beside its period. The vendor announces it once at first;
// a peer that missed that, or comes later, would wait for a period, which may be minutes. So it is announced
// a few times more at first, and once soon after a newcomer. Further announcements follow while a peer has
// not shown that it heard us, since the answer may have been lost. The intervals of both series double. A
// pure state machine, not thread-safe.
class AnnouncementRounds
{
public:
    using TimePoint = std::chrono::steady_clock::time_point;
    using Duration = std::chrono::steady_clock::duration;

    // After the first announcement: at 0.2, 0.6, 1.4, 3 and 6.2 s, unless a newcomer was just answered.
    static constexpr std::chrono::milliseconds InitialGap{200};
    static constexpr int InitialRounds = 5;
    // The same where other nodes learn of this one by its card: at 2 and 6 s. Only programs without a card
    // need them, and a crowd that starts has other things to send.
    static constexpr std::chrono::milliseconds InitialGapWithCard{2000};
    static constexpr int InitialRoundsWithCard = 2;
    // Limit of announcements for a newcomer; the last comes a minute or two after it.
    static constexpr int MostAnswers = 10;
    // Newcomers in quick succession, as over a thin radio, are answered together. Shortest time between two
    // announcements; it doubles with each announcement that follows another within Rest.
    static constexpr std::chrono::milliseconds ShortestSpacing{100};
    static constexpr std::chrono::milliseconds LongestSpacing{400};
    static constexpr std::chrono::milliseconds Rest{3200};

    // Begins when the participant was announced. `answerGap`: time from a newcomer to the answer, best
    // different for each node.
    AnnouncementRounds(Duration answerGap, TimePoint now, bool hasCard = false);

    // A peer has appeared.
    void OnPeer(TimePoint now);
    // When to call Next; empty: never.
    std::optional<TimePoint> Due() const;
    // Returns true if the participant should be announced now. `unheard`: a known peer has not shown yet that
    // it knows us.
    bool Next(TimePoint now, bool unheard);

private:
    const Duration _answerGap;
    BackoffTimer<TimePoint> _initial;
    BackoffTimer<TimePoint> _answers;
    bool _owesAnswer = false;  // a newcomer has had no answer yet
    TimePoint _last;           // when it was last announced
    Backoff _spacing{{ShortestSpacing, LongestSpacing}};
};

}  // namespace Rabit::Cyclone
