#pragma once

#include <cstddef>

namespace Rabit
{

// Computes the cost of a sample on the air: bytes of IP packets, as a radio carries them, with the headers of
// IPv4, UDP and RTPS 2.3. The vendor's own traffic (heartbeats, discovery) and the frames of the medium below
// IP are not included. Gateways plan what they send by it, and `rabit check` and `rabit meter` compute with
// it beforehand. A value without I/O: any thread may read it.
class AirCost
{
public:
    // Bytes of the headers.
    static constexpr std::size_t IpAndUdp = 20 + 8;
    static constexpr std::size_t RtpsHeader = 20;
    static constexpr std::size_t InfoTimestamp = 12;
    static constexpr std::size_t InfoDestination = 16;  // for one reader alone
    static constexpr std::size_t Data = 24;
    static constexpr std::size_t DataFragment = 36;
    static constexpr std::size_t Encapsulation = 4;

    // The receivers of a sample.
    struct Readers
    {
        std::size_t Destinations = 1;  // copies: 1 by multicast, however many readers there are
        bool Directed = false;         // names its reader
    };

    // maxDatagram: largest UDP payload, as TransportSettings::MaxDatagram.
    explicit AirCost(std::size_t maxDatagram) : _maxDatagram(maxDatagram) {}

    // The cost of a sample with a body of `body` bytes (CDR, without encapsulation). A sample that does not
    // fit a datagram goes in fragments.
    std::size_t Of(std::size_t body, Readers readers) const;
    std::size_t Of(std::size_t body) const { return Of(body, Readers{}); }
    // The cost of the sample's first datagram alone.
    std::size_t OfFirst(std::size_t body, Readers readers) const;
    // The largest body whose sample costs at most `bytesOnAir` for one destination, in one datagram; 0: none.
    std::size_t BodyWithin(std::size_t bytesOnAir, bool directed) const;

private:
    static std::size_t Before(bool directed);

    std::size_t _maxDatagram;
};

}  // namespace Rabit
