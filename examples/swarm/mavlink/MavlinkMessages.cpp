#include "MavlinkMessages.h"

#include <bit>
#include <type_traits>

namespace Swarm
{
namespace
{

// Fields go by size, the largest first, least byte first; the visitors below name them in that order.
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

template <typename Message, typename Visitor>
void VisitHeartbeat(Message &m, Visitor &&visit)
{
    visit(m.CustomMode);
    visit(m.Type);
    visit(m.Autopilot);
    visit(m.BaseMode);
    visit(m.SystemStatus);
    visit(m.ProtocolVersion);
}

template <typename Message, typename Visitor>
void VisitAttitude(Message &m, Visitor &&visit)
{
    visit(m.TimeSinceBootMs);
    visit(m.Roll);
    visit(m.Pitch);
    visit(m.Yaw);
    visit(m.RollSpeed);
    visit(m.PitchSpeed);
    visit(m.YawSpeed);
}

template <typename Message, typename Visitor>
void VisitGlobalPosition(Message &m, Visitor &&visit)
{
    visit(m.TimeSinceBootMs);
    visit(m.LatitudeE7);
    visit(m.LongitudeE7);
    visit(m.AltitudeMm);
    visit(m.RelativeAltitudeMm);
    visit(m.NorthCmps);
    visit(m.EastCmps);
    visit(m.DownCmps);
    visit(m.HeadingCdeg);
}

template <typename Message, typename Visitor>
void VisitPositionTarget(Message &m, Visitor &&visit)
{
    visit(m.TimeSinceBootMs);
    visit(m.LatitudeE7);
    visit(m.LongitudeE7);
    visit(m.AltitudeM);
    visit(m.VelocityNorth);
    visit(m.VelocityEast);
    visit(m.VelocityDown);
    visit(m.AccelerationNorth);
    visit(m.AccelerationEast);
    visit(m.AccelerationDown);
    visit(m.Yaw);
    visit(m.YawRate);
    visit(m.TypeMask);
    visit(m.TargetSystem);
    visit(m.TargetComponent);
    visit(m.CoordinateFrame);
}

template <typename Message, typename Visit>
MavlinkFrame EncodeWith(const Message &message, Visit visitFields)
{
    MavlinkFrame frame;
    frame.Message = Message::Number;
    Writer writer(frame.Payload);
    visitFields(message, writer);
    return frame;
}

template <typename Message, typename Visit>
std::optional<Message> DecodeWith(const MavlinkFrame &frame, Visit visitFields)
{
    if (frame.Message != Message::Number)
    {
        return std::nullopt;
    }
    Message message;
    Reader reader(frame.Payload);
    visitFields(message, reader);
    return message;
}

}  // namespace

MavlinkFrame MavlinkHeartbeat::Encode() const
{
    return EncodeWith(*this, [](auto &m, auto &visit) { VisitHeartbeat(m, visit); });
}

std::optional<MavlinkHeartbeat> MavlinkHeartbeat::Decode(const MavlinkFrame &frame)
{
    return DecodeWith<MavlinkHeartbeat>(frame, [](auto &m, auto &visit) { VisitHeartbeat(m, visit); });
}

MavlinkFrame MavlinkAttitude::Encode() const
{
    return EncodeWith(*this, [](auto &m, auto &visit) { VisitAttitude(m, visit); });
}

std::optional<MavlinkAttitude> MavlinkAttitude::Decode(const MavlinkFrame &frame)
{
    return DecodeWith<MavlinkAttitude>(frame, [](auto &m, auto &visit) { VisitAttitude(m, visit); });
}

MavlinkFrame MavlinkGlobalPosition::Encode() const
{
    return EncodeWith(*this, [](auto &m, auto &visit) { VisitGlobalPosition(m, visit); });
}

std::optional<MavlinkGlobalPosition> MavlinkGlobalPosition::Decode(const MavlinkFrame &frame)
{
    return DecodeWith<MavlinkGlobalPosition>(frame,
                                             [](auto &m, auto &visit) { VisitGlobalPosition(m, visit); });
}

MavlinkFrame MavlinkPositionTarget::Encode() const
{
    return EncodeWith(*this, [](auto &m, auto &visit) { VisitPositionTarget(m, visit); });
}

std::optional<MavlinkPositionTarget> MavlinkPositionTarget::Decode(const MavlinkFrame &frame)
{
    return DecodeWith<MavlinkPositionTarget>(frame,
                                             [](auto &m, auto &visit) { VisitPositionTarget(m, visit); });
}

}  // namespace Swarm
