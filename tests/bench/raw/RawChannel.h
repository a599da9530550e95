#pragma once

#include "../common/BenchOptions.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

namespace Rabit::Bench
{

// Bench::Sample as a plain program has it.
struct RawSample
{
    std::uint64_t Number = 0;
    std::int64_t SentAt = 0;
    std::span<const std::uint8_t> Padding;
};

// One writer and one reader of a plain DDS program that knows nothing of Rabit, as the vendor's manual has it
// written. QoS, datagrams, lease and heartbeats are set to what Rabit's backend of that vendor sets.
class RawChannel
{
public:
    virtual ~RawChannel() = default;
    // Writes one sample. False: it was not taken in time, and may be written again.
    virtual bool Write(const RawSample &sample) = 0;
    // Takes everything that has come and hands it over; the padding is valid during the call.
    virtual void Take(const std::function<void(const RawSample &)> &handler) = 0;
    // Whether both ends have met the other program's.
    virtual bool IsMatched() const = 0;
    // Returns when all that was written was acknowledged.
    virtual void WaitForAcknowledgements() = 0;
};

// Implemented once for each vendor. `onData` is called by the vendor's listener when there is something to
// take.
std::unique_ptr<RawChannel> OpenRawChannel(const BenchOptions &options, const std::string &writes,
                                           const std::string &reads, std::function<void()> onData);

}  // namespace Rabit::Bench
