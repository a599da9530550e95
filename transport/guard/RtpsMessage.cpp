#include "guard/RtpsMessage.h"

#include <rabit/base/Assert.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "common/RtpsWriter.h"

namespace Rabit::Rtps
{

bool HasRtpsHeader(std::span<const std::uint8_t> datagram)
{
    constexpr std::uint8_t MajorVersion = 2;
    return datagram.size() >= RtpsHeaderSize && std::memcmp(datagram.data(), "RTPS", 4) == 0 &&
           datagram[4] == MajorVersion && SenderOf(datagram) != GuidPrefix{};
}

bool IsWakeUpOfCycloneDds(std::span<const std::uint8_t> datagram)
{
    return datagram.size() == 1 && datagram[0] == 0;
}

GuidPrefix SenderOf(std::span<const std::uint8_t> datagram)
{
    return PrefixOf(datagram.subspan(PrefixAt));
}

bool PutSource(const Submessage &submessage, std::span<std::uint8_t> header)
{
    // 9.4.5.9: four bytes that mean nothing, then version, vendor and prefix as they are in a header.
    constexpr std::size_t Unused = 4;
    const auto body = submessage.Body();
    if (body.size() != RtpsHeaderSize)
    {
        return false;
    }
    std::copy(body.begin() + Unused, body.end(), header.begin() + Unused);
    return HasRtpsHeader(header);
}

std::optional<Submessage> TakeSubmessage(std::span<std::uint8_t> &rest)
{
    if (rest.size() < SubmessageHeaderSize)
    {
        return std::nullopt;
    }
    Submessage taken;
    taken.Kind = static_cast<SubmessageKind>(rest[0]);
    taken.Flags = rest[1];
    taken.LittleEndian = (taken.Flags & LittleEndianFlag) != 0;
    const std::size_t left = rest.size() - SubmessageHeaderSize;
    std::size_t length = RtpsReader(rest.subspan(2, 2), taken.LittleEndian).U16();
    if (length == 0 && taken.Kind != SubmessageKind::Pad && taken.Kind != SubmessageKind::InfoTimestamp)
    {
        length = left;  // 9.4.5.1.3: it extends to the end of the message
    }
    // 9.4.1: each submessage begins at a multiple of 4. A parser that rounds up would continue at another
    // byte than one that does not.
    if (length > left || (length < left && length % 4 != 0))
    {
        return std::nullopt;
    }
    taken.Whole = rest.first(SubmessageHeaderSize + length);
    rest = rest.subspan(taken.Whole.size());
    return taken;
}

bool EndsLikeStatistics(std::span<const std::uint8_t> datagram)
{
    return datagram.size() >= RtpsHeaderSize + StatisticsSize &&
           SubmessageKind{datagram[datagram.size() - StatisticsSize]} == SubmessageKind::Statistics;
}

std::size_t SizeWithoutStatistics(std::span<const std::uint8_t> datagram)
{
    bool hasStatistics = false;
    if (EndsLikeStatistics(datagram))
    {
        VisitSubmessages(datagram, [&](const ConstSubmessage &part)
                         { hasStatistics = part.Whole.data() == datagram.last(StatisticsSize).data(); });
    }
    return datagram.size() - (hasStatistics ? StatisticsSize : 0);
}

void Blank(const Submessage &submessage)
{
    // For padding a length of 0 means 0, for other kinds "to the end": the length is written out here.
    submessage.Whole[0] = static_cast<std::uint8_t>(SubmessageKind::Pad);
    Write(submessage.Whole.subspan(2, 2), submessage.Body().size(), submessage.LittleEndian);
}

void MakeGap(const Submessage &data)
{
    // 9.4.5.6: reader, writer, the first number, and a set without a bit that begins with the next number.
    constexpr std::size_t gapSize = 2 * sizeof(EntityId) + 2 * SequenceSize + sizeof(std::uint32_t);
    const auto whole = data.Whole;
    RABIT_ASSERT(whole.size() >= SubmessageHeaderSize + gapSize + SubmessageHeaderSize);
    RtpsReader body = data.Reader();
    body.Skip(ReaderInData);
    const auto entities = body.Bytes(2 * sizeof(EntityId));
    const std::int64_t number = body.Sequence();
    std::array<std::uint8_t, gapSize> gap{};
    const auto rest = std::copy(entities.begin(), entities.end(), gap.begin());
    // The announcement may name no reader, and Cyclone DDS heeds a GAP only if it names one.
    constexpr std::uint8_t builtinReader = 0xc7;  // 9.3.1.3; of the same key as the writer
    std::copy_n(gap.begin() + sizeof(EntityId), sizeof(EntityId) - 1, gap.begin());
    gap[sizeof(EntityId) - 1] = builtinReader;
    const auto numbers = std::span(gap).subspan(static_cast<std::size_t>(rest - gap.begin()));
    WriteSequence(numbers, number, data.LittleEndian);
    WriteSequence(numbers.subspan(SequenceSize), number + 1, data.LittleEndian);
    whole[0] = static_cast<std::uint8_t>(SubmessageKind::Gap);
    whole[1] = data.LittleEndian ? LittleEndianFlag : std::uint8_t{0};
    Write(whole.subspan(2, 2), gapSize, data.LittleEndian);
    std::copy(gap.begin(), gap.end(), whole.begin() + SubmessageHeaderSize);
    const auto padding = whole.subspan(SubmessageHeaderSize + gapSize);
    padding[1] = whole[1];
    Blank({.Kind = SubmessageKind::Pad,
           .Flags = whole[1],
           .LittleEndian = data.LittleEndian,
           .Whole = padding});
}

}  // namespace Rabit::Rtps
