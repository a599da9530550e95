// The samples of the transport tests: an encapsulation header, a key, a text.
#pragma once

#include <rabit/transport/Transport.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace Rabit::Conformance
{

// Encodes bytes as they are, behind a little-endian CDR header.
class RawSample final : public SampleEncoder
{
public:
    explicit RawSample(std::vector<std::uint8_t> body) : _body(std::move(body)) {}
    std::size_t EncodedSize() const override { return 4 + _body.size(); }
    bool Encode(std::span<std::uint8_t> buffer) const override;

private:
    const std::vector<std::uint8_t> _body;
};

RawSample MakeSample(std::uint32_t key, const std::string &text);

// Repeat Write or Dispose while the network does not take the sample in time.
WriteResult WriteOnceTaken(TransportWriter &writer, const SampleEncoder &sample, std::int64_t sourceTime);
WriteResult DisposeOnceTaken(TransportWriter &writer, const SampleEncoder &sample, std::int64_t sourceTime);

// Returns the text of a sample that MakeSample made.
std::string TextOf(SampleBytes bytes);

// Returns the hash of this key.
KeyHash HashOf(std::uint32_t key);

// A topic without a key.
TopicDescription TextTopic(const std::string &name = "Text");

// A topic with the key of MakeSample.
TopicDescription KeyedTopic(const std::string &name = "KeyedText");

inline TopicQos State(int depth = 1)
{
    return {Reliability::Reliable, Durability::TransientLocal, depth};
}
inline TopicQos Stream(int depth)
{
    return {Reliability::Reliable, Durability::Volatile, depth};
}
inline TopicQos Telemetry()
{
    return {Reliability::BestEffort, Durability::Volatile, 1};
}

}  // namespace Rabit::Conformance
