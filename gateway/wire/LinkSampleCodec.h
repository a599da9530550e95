#pragma once

#include <rabit/gateway/links/LinkMessages.h>
#include <rabit/transport/Transport.h>

#include <cstdint>
#include <span>

namespace Rabit
{

// Encodes a frame of the links as the sample of Rabit::Gateway::LinkSample that it is on the wire, straight
// into the transport's memory: its payloads are most of what a link carries, and would be copied once more on
// the way through an object of that class. The frame must outlive it unchanged.
class LinkSampleEncoder final : public SampleEncoder
{
public:
    explicit LinkSampleEncoder(const LinkFrame &frame);

    std::size_t EncodedSize() const override;
    bool Encode(std::span<std::uint8_t> buffer) const override;

private:
    const LinkFrame &_frame;
    const std::size_t _size;  // of the frame
};

// The same for a frame that is encoded already.
class FrameBytesEncoder final : public SampleEncoder
{
public:
    explicit FrameBytesEncoder(std::span<const std::uint8_t> frame) : _frame(frame) {}

    std::size_t EncodedSize() const override;
    bool Encode(std::span<std::uint8_t> buffer) const override;

private:
    const std::span<const std::uint8_t> _frame;
};

// The frame in such a sample, which a LinkFrameCodec may decode. False if the bytes are no such sample.
bool OpenLinkSample(SampleBytes bytes, std::span<const std::uint8_t> &frame);

}  // namespace Rabit
