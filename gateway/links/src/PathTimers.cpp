// The timers of a path: retransmission, delayed acknowledgements, reordering.
#include <algorithm>

#include "PathControl.h"

namespace Rabit
{

namespace
{

using namespace std::chrono_literals;

// The probe timer first doubles this many times: where much is lost, waiting longer does not help. When there
// is no path it goes on doubling.
constexpr int FirstDoublings = 2;
// While a peer holds its answers back, questions are repeated meanwhile, and the newest that it heard is not
// old. With this factor the timer grows until it covers the whole time.
constexpr int PatienceForAnswers = 3;
// A round trip that was once very long is no reason to wait for the next ones that long.
constexpr LinkTime LongestProbe = 3s;

}  // namespace

void PathControl::Answered(LinkTime time)
{
    _answers[_answered++ % _answers.size()] = time;
    if (_answered >= _answers.size())
    {
        const auto [a, b, c, d, e] = _answers;
        // Of four, the lowest and the highest cannot be the median of five.
        const LinkTime one = std::max(std::min(a, b), std::min(c, d));
        const LinkTime other = std::min(std::max(a, b), std::max(c, d));
        _usualAnswer = std::clamp(e, std::min(one, other), std::max(one, other));
    }
}

LinkTime PathControl::AckDelay() const
{
    return std::clamp(_times.Smoothed() * 5 / 4, _settings.AckDelay,
                      std::max(_settings.AckDelay, _settings.LongestAckDelay));
}

LinkTime PathControl::ReorderingTime() const
{
    return std::clamp(2 * _times.Variation(), std::min(_shortest / 4, _times.Smoothed()), _times.Smoothed());
}

// The bytes of the other paths that start may delay the answer. The delay is that of a medium on which an
// empty frame and its answer take the shortest round trip.
LinkTime PathControl::StartDelay() const
{
    if (!_starts || _starting <= _inFlight)
    {
        return LinkTime(0);
    }
    const std::size_t emptyFrames = (_starting - _inFlight) / (2 * _settings.AirOverhead);
    return std::min(_shortest * static_cast<LinkTime::rep>(emptyFrames), _settings.MaxResend);
}

LinkTime PathControl::ProbeTimeout(int doublings) const
{
    const LinkTime known =
        std::min(_times.Smoothed() + 4 * _times.Variation() + AckDelay() + StartDelay(), LongestProbe);
    const LinkTime least = _times.IsKnown() ? std::max(known, _settings.MinResend) : _settings.FirstResend;
    // The round trip is that of the path alone. A peer with a budget may send its answers much later.
    const LinkTime plain = std::max(least, std::min(PatienceForAnswers * _usualAnswer, _settings.MaxResend));
    const LinkTime longest = std::max(plain, _settings.MaxResend);
    const int shift = doublings < ProbesInVain ? std::min(doublings, FirstDoublings)
                                               : std::min(FirstDoublings + 1 + doublings - ProbesInVain, 10);
    return std::min<LinkTime>(plain * (1LL << shift), longest);
}

}  // namespace Rabit
