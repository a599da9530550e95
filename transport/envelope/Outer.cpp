#include "envelope/Outer.h"

#include <rabit/base/Assert.h>
#include <rabit/base/LittleEndian.h>

#include <algorithm>
#include <string_view>

namespace Rabit::Envelope
{

namespace
{

constexpr std::uint8_t SealedMark = 0x80;  // bits 7-6 are 10
constexpr std::uint8_t MarkBits = 0xc0;
constexpr std::uint8_t TwoBits = 0x03;
constexpr OuterKind ReservedKind{1};
constexpr std::size_t EpochAt = 1;
constexpr std::size_t TagAt = 3;
constexpr std::size_t NumberAt = 7;
constexpr std::string_view EnvelopeLabel = "Rabit envelope 1";

std::uint8_t BitsAt(std::uint8_t byte, unsigned shift)
{
    return static_cast<std::uint8_t>((byte >> shift) & TwoBits);
}

// Appends to bytes that are large enough.
class ContextFields
{
public:
    explicit ContextFields(std::span<std::uint8_t> to) : _rest(to) {}

    void Add(std::span<const std::uint8_t> field)
    {
        std::copy(field.begin(), field.end(), _rest.begin());
        _rest = _rest.subspan(field.size());
    }
    void Add(std::uint32_t number)
    {
        LittleEndian::Write(number, _rest.data());
        _rest = _rest.subspan(sizeof number);
    }
    std::size_t Left() const { return _rest.size(); }

private:
    std::span<std::uint8_t> _rest;
};

}  // namespace

std::size_t OuterOverhead(OuterKind kind)
{
    return OuterSize + TagSize + (kind == OuterKind::Pairwise ? 0 : sizeof(Signature)) +
           (kind == OuterKind::Claim ? IntroductionSize : 0);
}

OuterFault ReadOuter(std::span<const std::uint8_t> datagram, Outer &outer)
{
    if (datagram.empty())
    {
        return OuterFault::TooShort;
    }
    if ((datagram[0] & MarkBits) != SealedMark)
    {
        return OuterFault::NotSealed;
    }
    outer.Kind = OuterKind{BitsAt(datagram[0], 4)};
    outer.Class = OuterClass{BitsAt(datagram[0], 2)};
    outer.Header = BitsAt(datagram[0], 0);
    if (outer.Kind == ReservedKind)
    {
        return OuterFault::UnknownKind;
    }
    if (datagram.size() < OuterOverhead(outer.Kind))
    {
        return OuterFault::TooShort;
    }
    if (datagram.size() > LargestDatagram)
    {
        return OuterFault::TooLong;
    }
    if (outer.Class > OuterClass::Bulletin)
    {
        return OuterFault::UnknownClass;
    }
    if (outer.Kind == OuterKind::Claim && (outer.Class != OuterClass::Meeting || outer.Header != 0))
    {
        return OuterFault::WrongClass;
    }
    outer.Epoch = LittleEndian::Read<Epoch>(datagram.subspan(EpochAt, sizeof(Epoch)));
    outer.Tag = LittleEndian::Read<SessionTag>(datagram.subspan(TagAt, sizeof(SessionTag)));
    outer.Number = LittleEndian::Read<std::uint32_t>(datagram.subspan(NumberAt, sizeof(std::uint32_t)));
    return outer.Epoch == 0 ? OuterFault::NoEpoch : OuterFault::None;
}

void WriteOuter(const Outer &outer, std::span<std::uint8_t> to)
{
    RABIT_ASSERT(to.size() >= OuterSize && outer.Header <= TwoBits);
    to[0] = static_cast<std::uint8_t>(SealedMark | static_cast<unsigned>(outer.Kind) << 4 |
                                      static_cast<unsigned>(outer.Class) << 2 | outer.Header);
    LittleEndian::Write(outer.Epoch, to.data() + EpochAt);
    LittleEndian::Write(outer.Tag, to.data() + TagAt);
    LittleEndian::Write(outer.Number, to.data() + NumberAt);
}

End ReadIntroduction(std::span<const std::uint8_t> datagram, std::uint32_t &high)
{
    RABIT_ASSERT(datagram.size() >= OuterSize + IntroductionSize);
    auto rest = datagram.subspan(OuterSize, IntroductionSize);
    End sender;
    std::copy_n(rest.begin(), sender.Session.size(), sender.Session.begin());
    rest = rest.subspan(sender.Session.size());
    std::copy_n(rest.begin(), sender.Certificate.size(), sender.Certificate.begin());
    high = LittleEndian::Read<std::uint32_t>(rest.subspan(sender.Certificate.size()));
    return sender;
}

void WriteIntroduction(const End &sender, std::uint32_t high, std::span<std::uint8_t> to)
{
    RABIT_ASSERT(to.size() >= IntroductionSize);
    ContextFields fields(to);
    fields.Add(sender.Session);
    fields.Add(sender.Certificate);
    fields.Add(high);
}

void WriteOuterContext(std::span<const std::uint8_t> outer, std::uint64_t number, const End &sender,
                       const SessionId &receiver, const RtpsHeader &left, std::span<std::uint8_t> to)
{
    RABIT_ASSERT(to.size() >= OuterContextSize);
    ContextFields fields(to.first(OuterContextSize));
    fields.Add(std::span(reinterpret_cast<const std::uint8_t *>(EnvelopeLabel.data()), EnvelopeLabel.size()));
    fields.Add(outer.first(OuterSize));
    fields.Add(static_cast<std::uint32_t>(number >> 32));
    fields.Add(sender.Session);
    fields.Add(sender.Certificate);
    fields.Add(receiver);
    fields.Add(left);
    RABIT_ASSERT(fields.Left() == 0);
}

}  // namespace Rabit::Envelope
