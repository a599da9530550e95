#pragma once

#include <rabit/transport/Transport.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include "gateway.idl.h"
#include "presence/HeardBeat.h"

namespace Rabit
{

// Beats and events of peers on their way from the transport's threads to the gateway's. Drops and counts
// beats that are too large (before decoding) or malformed (after it), and all that finds the inbox full.
// Thread-safe.
class PresenceInbox
{
public:
    using Duration = std::chrono::nanoseconds;

    // Bytes of a beat on the wire, more than nodes send, and entries in each of its lists.
    static constexpr std::size_t LargestBeat = 4 * 1024;
    static constexpr std::size_t MostEntries = 256;
    // Largest contents of the inbox, in bytes on the wire plus the size of each entry. That is 1000 nodes
    // that send 4 kB each within one pass of the gateway: more is no fleet but a fault.
    static constexpr std::size_t LargestContents = 4 * 1024 * 1024;

    struct Contents
    {
        std::vector<HeardBeat> Beats;
        std::vector<PeerEvent> Events;
        std::vector<std::string> OtherFormats;  // nodes whose beats are of another version
    };

    // These return true if there is something to take.
    bool AddBeat(SampleBytes bytes, const SampleInfo &info, Duration arrival);
    bool AddEvent(const PeerEvent &event);

    Contents Take();
    // True if there is nothing to take. Takes no lock, since most passes of the gateway find nothing.
    bool IsEmpty() const { return !_any.load(std::memory_order_acquire); }
    // Number of samples that were malformed, and of samples and events that found the inbox full.
    std::uint64_t Dropped() const;

private:
    bool HasRoomFor(std::size_t bytes);
    bool Drop();

    mutable std::mutex _mutex;
    Contents _contents;
    std::size_t _bytes = 0;
    std::atomic<bool> _any{false};  // changed with the mutex held
    std::uint64_t _dropped = 0;
};

}  // namespace Rabit
