#include "MavlinkMessages.h"

#include <bit>
#include <tuple>
#include <type_traits>

namespace Swarm
{
namespace
{

// Fields are sorted by size, the largest first, and little endian; FieldsOf lists them in that order.
class Writer
{
public:
    explicit Writer(std::vector<std::uint8_t> &bytes) : _bytes(bytes) {}

    template <typename Field>
    void operator()(Field value)
    {
        if constexpr (std::is_same_v<Field, float>)
        {
            (*this)(std::bit_cast<std::uint32_t>(value));
        }
        else
        {
            const auto bits = static_cast<std::make_unsigned_t<Field>>(value);
            for (std::size_t i = 0; i < sizeof(Field); ++i)
            {
                _bytes.push_back(static_cast<std::uint8_t>((bits >> (8 * i)) & 0xFF));
            }
        }
    }

private:
    std::vector<std::uint8_t> &_bytes;
};

class Reader
{
public:
    explicit Reader(const std::vector<std::uint8_t> &bytes) : _bytes(bytes) {}

    template <typename Field>
    void operator()(Field &value)
    {
        if constexpr (std::is_same_v<Field, float>)
        {
            std::uint32_t bits = 0;
            (*this)(bits);
            value = std::bit_cast<float>(bits);
        }
        else
        {
            std::uint64_t bits = 0;
            for (std::size_t i = 0; i < sizeof(Field); ++i)
            {
                bits |= static_cast<std::uint64_t>(Byte()) << (8 * i);
            }
            value = static_cast<Field>(bits);
        }
    }

private:
    // Zeros at the end of a payload were not sent.
    std::uint8_t Byte()
    {
        const std::size_t at = _at++;
        return at < _bytes.size() ? _bytes[at] : std::uint8_t{0};
    }

    const std::vector<std::uint8_t> &_bytes;
    std::size_t _at = 0;
};

auto FieldsOf(const MavlinkHeartbeat &)
{
    using M = MavlinkHeartbeat;
    return std::tuple(&M::CustomMode, &M::Type, &M::Autopilot, &M::BaseMode, &M::SystemStatus,
                      &M::ProtocolVersion);
}

auto FieldsOf(const MavlinkAttitude &)
{
    using M = MavlinkAttitude;
    return std::tuple(&M::TimeSinceBootMs, &M::Roll, &M::Pitch, &M::Yaw, &M::RollSpeed, &M::PitchSpeed,
                      &M::YawSpeed);
}

auto FieldsOf(const MavlinkGlobalPosition &)
{
    using M = MavlinkGlobalPosition;
    return std::tuple(&M::TimeSinceBootMs, &M::LatitudeE7, &M::LongitudeE7, &M::AltitudeMm,
                      &M::RelativeAltitudeMm, &M::NorthCmps, &M::EastCmps, &M::DownCmps, &M::HeadingCdeg);
}

auto FieldsOf(const MavlinkPositionTarget &)
{
    using M = MavlinkPositionTarget;
    return std::tuple(&M::TimeSinceBootMs, &M::LatitudeE7, &M::LongitudeE7, &M::AltitudeM, &M::VelocityNorth,
                      &M::VelocityEast, &M::VelocityDown, &M::AccelerationNorth, &M::AccelerationEast,
                      &M::AccelerationDown, &M::Yaw, &M::YawRate, &M::TypeMask, &M::TargetSystem,
                      &M::TargetComponent, &M::CoordinateFrame);
}

template <typename Message>
MavlinkFrame EncodeFields(const Message &message)
{
    MavlinkFrame frame;
    frame.Message = Message::Number;
    Writer write(frame.Payload);
    std::apply([&](auto... field) { (write(message.*field), ...); }, FieldsOf(message));
    return frame;
}

template <typename Message>
std::optional<Message> DecodeFields(const MavlinkFrame &frame)
{
    if (frame.Message != Message::Number)
    {
        return std::nullopt;
    }
    Message message;
    Reader read(frame.Payload);
    std::apply([&](auto... field) { (read(message.*field), ...); }, FieldsOf(message));
    return message;
}

}  // namespace

MavlinkFrame MavlinkHeartbeat::Encode() const
{
    return EncodeFields(*this);
}

std::optional<MavlinkHeartbeat> MavlinkHeartbeat::Decode(const MavlinkFrame &frame)
{
    return DecodeFields<MavlinkHeartbeat>(frame);
}

MavlinkFrame MavlinkAttitude::Encode() const
{
    return EncodeFields(*this);
}

std::optional<MavlinkAttitude> MavlinkAttitude::Decode(const MavlinkFrame &frame)
{
    return DecodeFields<MavlinkAttitude>(frame);
}

MavlinkFrame MavlinkGlobalPosition::Encode() const
{
    return EncodeFields(*this);
}

std::optional<MavlinkGlobalPosition> MavlinkGlobalPosition::Decode(const MavlinkFrame &frame)
{
    return DecodeFields<MavlinkGlobalPosition>(frame);
}

MavlinkFrame MavlinkPositionTarget::Encode() const
{
    return EncodeFields(*this);
}

std::optional<MavlinkPositionTarget> MavlinkPositionTarget::Decode(const MavlinkFrame &frame)
{
    return DecodeFields<MavlinkPositionTarget>(frame);
}

}  // namespace Swarm
