#include "MavlinkFrame.h"

#include "MavlinkMessages.h"

#include <algorithm>
#include <stdexcept>

namespace Swarm
{
namespace
{

constexpr std::uint8_t StartOfOne = 0xFE;
constexpr std::uint8_t StartOfTwo = 0xFD;
constexpr std::size_t HeaderOfOne = 6;
constexpr std::size_t HeaderOfTwo = 10;
constexpr std::size_t ChecksumSize = 2;
constexpr std::size_t SignatureSize = 13;
constexpr std::uint8_t IsSigned = 1;  // the only defined incompatible flag

void AppendChecksum(std::vector<std::uint8_t> &bytes, std::uint8_t extra)
{
    // The checksum of all bytes except the start byte, followed by the extra byte of the message type.
    const std::uint16_t sum = MavlinkChecksum({&extra, 1}, MavlinkChecksum(std::span(bytes).subspan(1)));
    bytes.push_back(static_cast<std::uint8_t>(sum & 0xFF));
    bytes.push_back(static_cast<std::uint8_t>(sum >> 8));
}

// At least one byte of a payload is always sent.
std::size_t LengthWithoutZeros(const std::vector<std::uint8_t> &payload)
{
    const auto last =
        std::find_if(payload.rbegin(), payload.rend(), [](std::uint8_t byte) { return byte != 0; });
    return std::max<std::size_t>(static_cast<std::size_t>(payload.rend() - last), 1);
}

}  // namespace

std::optional<std::uint8_t> MavlinkExtraOf(std::uint32_t message)
{
    switch (message)
    {
        case MavlinkHeartbeat::Number:
            return MavlinkHeartbeat::Extra;
        case MavlinkAttitude::Number:
            return MavlinkAttitude::Extra;
        case MavlinkGlobalPosition::Number:
            return MavlinkGlobalPosition::Extra;
        case MavlinkPositionTarget::Number:
            return MavlinkPositionTarget::Extra;
        default:
            return std::nullopt;
    }
}

std::uint16_t MavlinkChecksum(std::span<const std::uint8_t> bytes, std::uint16_t before)
{
    std::uint16_t sum = before;
    for (const std::uint8_t byte : bytes)
    {
        sum = static_cast<std::uint16_t>(sum ^ byte);
        for (int bit = 0; bit < 8; ++bit)
        {
            // x^16 + x^12 + x^5 + 1, lowest bit first.
            sum = static_cast<std::uint16_t>((sum & 1) != 0 ? (sum >> 1) ^ 0x8408 : sum >> 1);
        }
    }
    return sum;
}

std::vector<std::uint8_t> EncodeMavlink(const MavlinkFrame &frame)
{
    const std::optional<std::uint8_t> extra = MavlinkExtraOf(frame.Message);
    const bool one = frame.Protocol == MavlinkFrame::Version::One;
    if (!extra || frame.Payload.empty() || frame.Payload.size() > MavlinkFrame::LargestPayload ||
        (one && frame.Message > 255))
    {
        throw std::invalid_argument("not a MAVLink message that can be sent");
    }
    const std::size_t length = one ? frame.Payload.size() : LengthWithoutZeros(frame.Payload);
    std::vector<std::uint8_t> bytes;
    bytes.reserve(HeaderOfTwo + length + ChecksumSize);
    const auto put = [&bytes](std::size_t value)
    { bytes.push_back(static_cast<std::uint8_t>(value & 0xFF)); };
    put(one ? StartOfOne : StartOfTwo);
    put(length);
    if (!one)
    {
        put(0);  // incompatible flags: not signed
        put(0);  // compatible flags
    }
    put(frame.Sequence);
    put(frame.System);
    put(frame.Component);
    put(frame.Message);
    if (!one)
    {
        put(frame.Message >> 8);
        put(frame.Message >> 16);
    }
    bytes.insert(bytes.end(), frame.Payload.begin(),
                 frame.Payload.begin() + static_cast<std::ptrdiff_t>(length));
    AppendChecksum(bytes, *extra);
    return bytes;
}

void MavlinkParser::Add(std::span<const std::uint8_t> bytes)
{
    _bytes.erase(_bytes.begin(), _bytes.begin() + static_cast<std::ptrdiff_t>(_begin));
    _begin = 0;
    _bytes.insert(_bytes.end(), bytes.begin(), bytes.end());
}

std::optional<MavlinkFrame> MavlinkParser::Next()
{
    while (_begin < _bytes.size())
    {
        MavlinkFrame frame;
        std::size_t length = 0;
        switch (TryAt(_begin, frame, length))
        {
            case Result::Frame:
                ++_counters.Frames;
                _begin += length;
                return frame;
            case Result::Unknown:
                ++_counters.Unknown;
                _begin += length;
                break;
            case Result::Incomplete:
                return std::nullopt;
            case Result::NotHere:
                ++_counters.Skipped;
                ++_begin;
                break;
        }
    }
    return std::nullopt;
}

MavlinkParser::Result MavlinkParser::TryAt(std::size_t start, MavlinkFrame &frame, std::size_t &length)
{
    const std::span<const std::uint8_t> rest = std::span(_bytes).subspan(start);
    if (rest[0] != StartOfOne && rest[0] != StartOfTwo)
    {
        return Result::NotHere;
    }
    const bool one = rest[0] == StartOfOne;
    const std::size_t header = one ? HeaderOfOne : HeaderOfTwo;
    if (rest.size() < header)
    {
        return Result::Incomplete;
    }
    frame.Protocol = one ? MavlinkFrame::Version::One : MavlinkFrame::Version::Two;
    const std::size_t ids = one ? 2 : 4;
    frame.Sequence = rest[ids];
    frame.System = rest[ids + 1];
    frame.Component = rest[ids + 2];
    frame.Message = rest[ids + 3];
    if (!one)
    {
        frame.Message |=
            static_cast<std::uint32_t>(rest[ids + 4]) << 8 | static_cast<std::uint32_t>(rest[ids + 5]) << 16;
    }
    const std::uint8_t incompatible = one ? std::uint8_t{0} : rest[2];
    const std::optional<std::uint8_t> extra = MavlinkExtraOf(frame.Message);
    const std::size_t checked = header + rest[1];
    length = checked + ChecksumSize + ((incompatible & IsSigned) != 0 ? SignatureSize : 0);
    if (rest.size() < length)
    {
        return Result::Incomplete;
    }
    if (!extra || (incompatible & ~IsSigned) != 0)
    {
        // The checksum of an unknown type cannot be computed. If a frame or the end follows, it was a
        // frame.
        const bool whole = rest.size() == length || rest[length] == StartOfOne || rest[length] == StartOfTwo;
        return whole ? Result::Unknown : Result::NotHere;
    }
    const std::uint16_t sum = MavlinkChecksum({&*extra, 1}, MavlinkChecksum(rest.subspan(1, checked - 1)));
    if (rest[checked] != (sum & 0xFF) || rest[checked + 1] != sum >> 8)
    {
        ++_counters.BadChecksum;
        return Result::NotHere;
    }
    frame.Payload.assign(rest.begin() + static_cast<std::ptrdiff_t>(header),
                         rest.begin() + static_cast<std::ptrdiff_t>(checked));
    return Result::Frame;
}

}  // namespace Swarm
