#pragma once

#include <rabit/gateway/links/LinkOptions.h>
#include <rabit/gateway/links/LinkTime.h>

#include <cstddef>

namespace Rabit
{

// Bytes of payloads that a link may have in flight. LinkOptions::WindowBytes suits a radio. On a path whose
// round trip stays short the window doubles with each round trip that fills it, up to LargestWindowBytes: a
// round trip that grows tells that a buffer on the way fills up, long before something is lost, and the
// window is as at the beginning again (the delay-based control of LEDBAT, RFC 6817, without its pacing). A
// window that was not used says nothing about the path: it does not grow, and starts anew after a pause (RFC
// 7661, RFC 5681 4.1).
class ByteWindow
{
public:
    ByteWindow(const LinkOptions &options, LinkTime shortRoundTrip);

    bool Fits(std::size_t inFlight, std::size_t next) const { return inFlight + next <= _bytes; }

    // A round trip was measured.
    void Measured(LinkTime roundTrip);
    // So many bytes were acknowledged; so many had been in flight.
    void Acknowledged(std::size_t bytes, std::size_t inFlight);
    // Something was lost, the stream begins anew, or nothing was sent for a while.
    void Restore() { _bytes = _smallest; }

    std::size_t Bytes() const { return _bytes; }

private:
    const std::size_t _smallest;
    const std::size_t _largest;
    const LinkTime _shortRoundTrip;
    std::size_t _bytes;
    bool _isShort = false;  // the last measured round trip
};

}  // namespace Rabit
