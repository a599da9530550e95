#pragma once

#include "../common/BenchOptions.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

namespace Rabit::Bench
{

// Bench::Sample in a plain program.
struct RawSample
{
    std::uint64_t Number = 0;
    std::int64_t SentAt = 0;
    std::span<const std::uint8_t> Padding;
};

// One writer and one reader of a plain DDS program that knows nothing of Rabit, written as the vendor's
// manual shows. QoS, datagrams, lease and heartbeats have the values that Rabit's backend of that vendor
// sets.
class RawChannel
{
public:
    virtual ~RawChannel() = default;
    // Writes one sample. Returns false if the vendor did not take it in time; it may be written again.
    virtual bool Write(const RawSample &sample) = 0;
    // Takes all samples that have come and passes them to `handler`. The padding is valid during the call.
    virtual void Take(const std::function<void(const RawSample &)> &handler) = 0;
    // True if both ends have met the other program's.
    virtual bool IsMatched() const = 0;
    // Returns when all written samples are acknowledged.
    virtual void WaitForAcknowledgements() = 0;
};

// Implemented once for each vendor. `onData` is called by the vendor's listener when there is something to
// take.
std::unique_ptr<RawChannel> OpenRawChannel(const BenchOptions &options, const std::string &writes,
                                           const std::string &reads, std::function<void()> onData);

}  // namespace Rabit::Bench
