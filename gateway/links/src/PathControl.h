#pragma once

#include "RoundTrip.h"

#include <rabit/gateway/links/LinkOptions.h>
#include <rabit/gateway/links/LinkTime.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace Rabit
{

// How much may be under way to one node, and how fast it may be sent. All links to the node share it.
//
// Delay that rises is congestion: what is under way beyond what the path itself holds waits in a buffer. The
// window is brought to where the wait is a target (FAST TCP: window x (shortest round trip + target) / round
// trip, once in each round trip; the target is that of LEDBAT, RFC 6817, plus the time that one datagram
// takes). Below the target the window grows, twofold in slow start. The shortest round trip is measured anew
// now and then, with next to nothing under way (BBR's PROBE_RTT). Loss alone is not congestion, a radio
// loses: it shortens the target, since a buffer that overflows before the target is reached loses as well.
// Where the round trip is that of a wire, what is lost has overflowed a socket's buffer. The window then
// shrinks by a third, down to what a radio needs.
//
// Paths of one node that start at the same time may lead over one medium: they share the first window, as in
// RFC 9040, and each may have one datagram under way.
//
// Bytes are as on the air, all headers included.
class PathControl
{
public:
    // `starting`: the bytes under way on all paths of this node that start. All of them count there, and it
    // outlives them.
    PathControl(const LinkSettings &settings, std::size_t &starting);
    ~PathControl() { Leave(_inFlight); }
    PathControl(const PathControl &) = delete;
    PathControl &operator=(const PathControl &) = delete;

    // That many bytes were sent / acknowledged / found to be lost / are not waited for any more.
    void Sent(std::size_t bytes, LinkTime now);
    void Acknowledged(std::size_t bytes, LinkTime now);
    void Lost(std::size_t bytes);
    void Forget(std::size_t bytes) { Leave(bytes); }
    // A frame sent at that time was answered.
    void Measured(LinkTime roundTrip, LinkTime sentAt, LinkTime now);
    // A frame that asks for an answer was answered after that time, which includes the time for which the
    // peer held the answer back. Where several ask, the newest that was heard counts. If an answer was lost,
    // the next frame of the peer makes the time longer: the median of the last few counts.
    void Answered(LinkTime time);
    // Nothing came back for long: the measurements of the path may be wrong.
    void Restart();
    // It is another path from now on: nothing measured holds.
    void Replace();
    // Several probes are unanswered: what is under way is lost, or nobody is there, and holds up no other
    // path.
    void LeaveStart()
    {
        _starting -= _starts ? _inFlight : 0;
        _starts = false;
    }

    // True if the window has room for another datagram, or the larger part of one.
    bool HasRoom() const;
    // True if the datagram being sent, which others follow, must ask for an immediate acknowledgement, so
    // that the sender need not wait for one. If true, it counts as asked.
    bool TakeAsk(LinkTime now);
    // The next datagram should not be sent before this.
    LinkTime PacedUntil() const { return _pacedUntil; }

    std::size_t InFlight() const { return _inFlight; }
    std::size_t Window() const;
    const RoundTrip &Times() const { return _times; }
    LinkTime Shortest() const { return _shortest; }  // 0: not measured yet
    LinkTime QueueingDelay() const { return _queueingDelay; }
    // Share of the sent bytes that was lost lately, 0 to 1.
    double LossRate() const { return _lossRate; }
    // Bytes per second that arrived in the last round trip with a full window; 0: not known.
    double DeliveryRate() const { return _rate; }
    // How long an acknowledgement may wait for others.
    LinkTime AckDelay() const;
    // After this many unanswered probes there is no path.
    static constexpr int ProbesInVain = 40;
    // How long to wait for an answer before the next probe, after `doublings` unanswered ones.
    LinkTime ProbeTimeout(int doublings = 0) const;
    // How much later than frames sent at the same time a frame may come without counting as lost.
    LinkTime ReorderingTime() const;
    // A round trip that only a wire has.
    bool IsShort() const;

private:
    void Enter(std::size_t bytes)
    {
        _inFlight += bytes;
        _starting += _starts ? bytes : 0;
    }
    void Leave(std::size_t bytes)
    {
        _inFlight -= bytes;
        _starting -= _starts ? bytes : 0;
    }
    void LookIfStarts();
    LinkTime StartDelay() const;
    std::size_t Datagram() const { return _datagram; }
    std::size_t FirstWindow() const { return 4 * _datagram; }
    LinkTime Target() const;
    double WeightOf(std::size_t bytes) const;
    double Pace() const;  // bytes per second
    void LookForEndOfSlowStart(double rate);
    void EndRound(LinkTime now);
    void Decide(LinkTime roundTrip);
    void RememberShortest(LinkTime roundTrip, LinkTime now);

    const LinkSettings &_settings;
    const std::size_t _datagram;  // the largest
    RoundTrip _times;
    std::array<LinkTime, 5> _answers{};
    std::size_t _answered = 0;
    LinkTime _usualAnswer{0};  // the median of _answers; 0: not known yet
    std::size_t _inFlight = 0;
    std::size_t &_starting;
    std::size_t _window;
    bool _slowStart = true;
    // True until the path has shown that it carries more than the first window, or less.
    bool _starts = true;
    int _stalled = 0;  // round trips in which slow start came no further
    LinkTime _pacedUntil{0};
    std::size_t _sinceAsked = 0;
    LinkTime _askedAt{0};
    LinkTime _echoed{0};  // when the newest frame was sent that is known to have arrived

    LinkTime _shortest{0};
    LinkTime _shortestAt{0};
    LinkTime _queueingDelay{0};
    bool _draining = false;
    LinkTime _drainStart{0};
    LinkTime _drainedAt = LinkNever;

    // The present round: it ends with the first answer to what was sent after the last decision.
    LinkTime _roundStart{0};
    LinkTime _roundShortest = LinkNever;
    std::size_t _roundAcknowledged = 0;
    std::size_t _roundLost = 0;
    std::size_t _roundSent = 0;  // as far as it was paced
    bool _wasFull = false;       // the window was used up in this round

    double _rate = 0;
    double _lossRate = 0;
};

}  // namespace Rabit
