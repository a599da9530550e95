#include "wire/LinkSampleCodec.h"

#include <rabit/gateway/links/LinkFrameCodec.h>
#include <rabit/idl/CdrReader.h>
#include <rabit/idl/CdrWriter.h>
#include <rabit/idl/GeneratedMessageType.h>

#include <algorithm>
#include <cstddef>

namespace Rabit
{
namespace
{

// Of the sequence.
constexpr std::size_t LengthSize = 4;

std::size_t SizeOfSample(std::size_t frame)
{
    return Idl::SampleSize(LengthSize + frame);
}

// All of a sample but its frame, whose bytes it returns for filling; the buffer is as large as the sample.
std::span<std::uint8_t> WrapFrame(std::span<std::uint8_t> buffer, std::size_t size)
{
    for (std::size_t i = 0; i < LengthSize; ++i)
    {
        buffer[Idl::EncapsulationSize + i] = static_cast<std::uint8_t>(size >> (8 * i));
    }
    const std::size_t head = Idl::EncapsulationSize + LengthSize;
    const std::size_t padding = buffer.size() - head - size;
    for (std::size_t i = 0; i < padding; ++i)
    {
        buffer[head + size + i] = 0;
    }
    Idl::WriteEncapsulation(buffer, padding);
    return buffer.subspan(head, size);
}

}  // namespace

LinkSampleEncoder::LinkSampleEncoder(const LinkFrame &frame)
    : _frame(frame), _size(LinkFrameCodec::EncodedSize(frame))
{
}

std::size_t LinkSampleEncoder::EncodedSize() const
{
    return SizeOfSample(_size);
}

bool LinkSampleEncoder::Encode(std::span<std::uint8_t> buffer) const
{
    if (buffer.size() != EncodedSize())
    {
        return false;
    }
    LinkFrameCodec::Encode(_frame, WrapFrame(buffer, _size));
    return true;
}

std::size_t FrameBytesEncoder::EncodedSize() const
{
    return SizeOfSample(_frame.size());
}

bool FrameBytesEncoder::Encode(std::span<std::uint8_t> buffer) const
{
    if (buffer.size() != EncodedSize())
    {
        return false;
    }
    std::copy(_frame.begin(), _frame.end(), WrapFrame(buffer, _frame.size()).begin());
    return true;
}

bool OpenLinkSample(SampleBytes bytes, std::span<const std::uint8_t> &frame)
{
    std::span<const std::uint8_t> body;
    bool littleEndian = true;
    if (!Idl::OpenSample(bytes, body, littleEndian))
    {
        return false;
    }
    try
    {
        Idl::CdrReader reader(body, littleEndian);
        std::size_t size = 0;
        return reader.GetLength(0, 1, size) && reader.GetBytes(size, frame) &&
               reader.Left() <= Idl::MaxPadding;
    }
    catch (const eprosima::fastcdr::exception::Exception &)
    {
        return false;
    }
}

}  // namespace Rabit
