#include "AnnouncementRounds.h"

#include <rabit/base/Earliest.h>

#include <utility>

namespace Rabit::Cyclone
{
namespace
{

// A series that begins `gap` after the first announcement.
Backoff::Settings SeriesOf(Backoff::Duration gap, int rounds)
{
    return {2 * gap, Backoff::Duration::max(), 2.0, rounds};
}

}  // namespace

AnnouncementRounds::AnnouncementRounds(Duration answerGap, TimePoint now, bool hasCard)
    : _answerGap(answerGap),
      _initial(hasCard ? SeriesOf(InitialGapWithCard, InitialRoundsWithCard)
                       : SeriesOf(InitialGap, InitialRounds)),
      _answers(SeriesOf(answerGap, MostAnswers)),
      _last(now)
{
    _initial.Begin(now + (hasCard ? InitialGapWithCard : InitialGap));
}

void AnnouncementRounds::OnPeer(TimePoint now)
{
    // An answer that is due already serves this newcomer too.
    if (!std::exchange(_owesAnswer, true))
    {
        _answers.Begin(now + _answerGap);
        _answers.Postpone(_last + _spacing.Interval());
    }
}

std::optional<AnnouncementRounds::TimePoint> AnnouncementRounds::Due() const
{
    return Earliest({_initial.Due(), _answers.Due()});
}

bool AnnouncementRounds::Next(TimePoint now, bool unheard)
{
    bool announces = false;
    if (_answers.IsDue(now))
    {
        announces = std::exchange(_owesAnswer, false) || unheard;
        announces ? _answers.Done(now) : _answers.Stop();
    }
    if (_initial.IsDue(now))
    {
        announces = announces || now - _last >= _initial.Interval() / 2;
        _initial.Done(now);
    }
    if (announces)
    {
        now - _last >= Rest ? _spacing.Reset() : static_cast<void>(_spacing.Next());
        _last = now;
    }
    return announces;
}

}  // namespace Rabit::Cyclone
