#pragma once

#include <rabit/transport/Transport.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace Rabit::Bench
{

// A network without a cost of its own: a write passes the bytes to the readers at once, on the writer's
// thread. It allocates nothing once its buffers are warm, so only the gateway's work is counted. One
// thread, no faults; topics match by name and partition, QoS does not matter, and nothing is kept for late
// readers.
class Wire
{
public:
    struct Reader;
    struct Session;

    // Sums over all sessions so far. One write arrives at each reader that matches.
    struct Traffic
    {
        std::uint64_t Writes = 0;
        std::uint64_t WrittenBytes = 0;
        std::uint64_t Arrivals = 0;
        std::uint64_t ArrivedBytes = 0;
    };

    Traffic Total;

    std::vector<Session *> Sessions;
    std::vector<Reader *> Readers;
};

class WiredTransport final : public Transport
{
public:
    explicit WiredTransport(Wire &wire) : _wire(wire) {}
    std::string Name() const override { return "wired"; }
    bool IsStepped() const override { return true; }
    std::unique_ptr<TransportSession> Open(const TransportSettings &settings, PeerHandler onPeer) override;

private:
    Wire &_wire;
};

}  // namespace Rabit::Bench
