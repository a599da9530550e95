#include "wire/LinkSampleCodec.h"

#include <rabit/gateway/links/LinkFrameCodec.h>
#include <rabit/idl/CdrReader.h>
#include <rabit/idl/CdrWriter.h>
#include <rabit/idl/GeneratedMessageType.h>

#include <cstddef>

namespace Rabit
{
namespace
{

// Of the sequence.
constexpr std::size_t LengthSize = 4;

}  // namespace

LinkSampleEncoder::LinkSampleEncoder(const LinkFrame &frame)
    : _frame(frame), _size(LinkFrameCodec::EncodedSize(frame))
{
}

std::size_t LinkSampleEncoder::EncodedSize() const
{
    return Idl::SampleSize(LengthSize + _size);
}

bool LinkSampleEncoder::Encode(std::span<std::uint8_t> buffer) const
{
    if (buffer.size() != EncodedSize())
    {
        return false;
    }
    for (std::size_t i = 0; i < LengthSize; ++i)
    {
        buffer[Idl::EncapsulationSize + i] = static_cast<std::uint8_t>(_size >> (8 * i));
    }
    const std::size_t head = Idl::EncapsulationSize + LengthSize;
    LinkFrameCodec::Encode(_frame, buffer.subspan(head, _size));
    const std::size_t padding = buffer.size() - head - _size;
    for (std::size_t i = 0; i < padding; ++i)
    {
        buffer[head + _size + i] = 0;
    }
    Idl::WriteEncapsulation(buffer, padding);
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
