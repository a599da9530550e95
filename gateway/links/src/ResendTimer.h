#pragma once

#include <rabit/gateway/links/LinkOptions.h>
#include <rabit/gateway/links/LinkTime.h>

namespace Rabit
{

// How long to wait for an acknowledgement before sending again: the retransmission timeout of RFC 6298, with
// the bounds of LinkSettings in place of the RFC's one second to one minute. Acknowledgements carry the time
// at which what they acknowledge was sent (RFC 7323), so that each gives a measurement, also of what was sent
// twice: on a path that loses much the timer does not stay backed off.
class ResendTimer
{
public:
    explicit ResendTimer(const LinkSettings &settings);

    // A round trip was measured: the path carries, so the back-off ends.
    void Measured(LinkTime roundTrip);
    // The timer ran out: wait twice as long next time (5.5), but not for ever longer.
    void BackOff();
    // A new stream begins.
    void Restore() { _backOff = 0; }

    // The time to wait, back-off included.
    LinkTime Timeout() const;
    // The time to wait without back-off.
    LinkTime PlainTimeout() const;
    // Smoothed round trip; 0 before the first measurement.
    LinkTime RoundTrip() const { return _smoothed; }

private:
    LinkTime _first;
    LinkTime _min;
    LinkTime _max;
    LinkTime _smoothed{0};   // SRTT
    LinkTime _variation{0};  // RTTVAR
    int _backOff = 0;        // doublings
};

}  // namespace Rabit
