#pragma once

#include <chrono>
#include <optional>

namespace Rabit::Cyclone
{

// Decides when our participant is announced to all beside its period. The vendor does so once as it comes;
// whoever missed that, or comes later, would wait for a period, which may be minutes. So it is announced a
// few times more at first; once soon after somebody has come; and further as long as somebody has not shown
// that it heard us, since that answer may have been lost. Either series at doubling distances. A pure state
// machine, not thread-safe.
class AnnouncementRounds
{
public:
    using TimePoint = std::chrono::steady_clock::time_point;
    using Duration = std::chrono::steady_clock::duration;

    // After the very first: at 0.2, 0.6, 1.4, 3 and 6.2 s, unless somebody was just answered.
    static constexpr std::chrono::milliseconds InitialGap{200};
    static constexpr int InitialRounds = 5;
    // The same where other nodes learn of this one by its card: programs without a card need them alone.
    static constexpr int InitialRoundsWithCard = 2;
    // After a newcomer; the last a minute or two after it.
    static constexpr int MostAnswers = 10;
    // Newcomers who come one after another, as over a thin radio, are answered together: no sooner than that
    // after the last announcement, twice as long after each that followed one within Rest.
    static constexpr std::chrono::milliseconds ShortestSpacing{100};
    static constexpr std::chrono::milliseconds LongestSpacing{400};
    static constexpr std::chrono::milliseconds Rest{3200};

    // Begins when the participant was announced. `answerGap`: from a newcomer to the answer; best not the
    // same for all who answer.
    AnnouncementRounds(Duration answerGap, TimePoint now, bool hasCard = false);

    // Somebody has come.
    void OnPeer(TimePoint now);
    // When Next is to be called, if at all.
    std::optional<TimePoint> Due() const;
    // Whether to announce ourselves. `unheard`: somebody whom we know has not shown that it knows us.
    bool Next(TimePoint now, bool unheard);

private:
    struct Series
    {
        std::optional<TimePoint> Due;
        Duration Gap{};
        int Left = 0;

        void Begin(TimePoint now, Duration gap, int rounds);
        bool Pass(TimePoint now);  // whether one of them is due
    };

    const Duration _answerGap;
    Series _initial;
    Series _answers;
    TimePoint _last;  // time that it was announced
    Duration _spacing = ShortestSpacing;
};

}  // namespace Rabit::Cyclone
