#include "AnnouncementRounds.h"

#include <algorithm>

namespace Rabit::Cyclone
{

void AnnouncementRounds::Series::Begin(TimePoint now, Duration gap, int rounds)
{
    Gap = gap;
    Due = now + Gap;
    Left = rounds;
}

bool AnnouncementRounds::Series::Pass(TimePoint now)
{
    if (!Due || now < *Due)
    {
        return false;
    }
    Gap *= 2;
    Due = --Left > 0 ? std::optional(now + Gap) : std::nullopt;
    return true;
}

AnnouncementRounds::AnnouncementRounds(Duration answerGap, TimePoint now, bool hasCard)
    : _answerGap(answerGap), _last(now)
{
    hasCard ? _initial.Begin(now, InitialGapWithCard, InitialRoundsWithCard)
            : _initial.Begin(now, InitialGap, InitialRounds);
}

void AnnouncementRounds::OnPeer(TimePoint now)
{
    // An answer that is due already serves this newcomer too.
    if (!_answers.Due || _answers.Left < MostAnswers)
    {
        _answers.Begin(now, _answerGap, MostAnswers);
        _answers.Due = std::max(*_answers.Due, _last + _spacing);
    }
}

std::optional<AnnouncementRounds::TimePoint> AnnouncementRounds::Due() const
{
    if (_initial.Due && _answers.Due)
    {
        return std::min(*_initial.Due, *_answers.Due);
    }
    return _initial.Due ? _initial.Due : _answers.Due;
}

bool AnnouncementRounds::Next(TimePoint now, bool unheard)
{
    const bool isFirstAnswer = _answers.Left == MostAnswers;
    const bool answers = _answers.Pass(now);
    if (answers && !isFirstAnswer && !unheard)
    {
        _answers.Due.reset();
    }
    const Duration initialGap = _initial.Gap;
    const bool initial = _initial.Pass(now) && now - _last >= initialGap;
    const bool announces = initial || (answers && (isFirstAnswer || unheard));
    if (announces)
    {
        _spacing = now - _last >= Rest ? Duration(ShortestSpacing)
                                       : std::min<Duration>(2 * _spacing, LongestSpacing);
        _last = now;
    }
    return announces;
}

}  // namespace Rabit::Cyclone
