#include "rtps/CardMessage.h"

#include <algorithm>
#include <array>

#include "guard/RtpsReader.h"

namespace Rabit::Rtps
{

namespace
{

constexpr std::array<std::uint8_t, 8> Header{'R', 'T', 'P', 'S', 2, 2, 'R', 'b'};
constexpr auto Kind = static_cast<SubmessageKind>(0xd2);
// The USER_DATA `card=2;` tells other nodes that this node understands it (common/ParticipantIdentity.h).
constexpr std::uint8_t Format = 2;
constexpr std::size_t RequestsAt = 20;
constexpr std::size_t RequestSize = GuidPrefix{}.size() + 8;
constexpr std::size_t AnswersSize = GuidPrefix{}.size() + 4;
constexpr std::size_t Alignment = 4;
// Enough for padding alone to stand where statistics would begin.
constexpr std::size_t MostPadding = StatisticsSize + 2 * Alignment;

std::uint64_t U64(RtpsReader &body)
{
    const std::uint64_t low = body.U32();
    return std::uint64_t{body.U32()} << 32 | low;
}

std::size_t SizeOfPart(const CardSummary &summary, std::size_t part)
{
    return std::min(CardPartSize, summary.Size - part * CardPartSize);
}

}  // namespace

std::size_t CardSummary::Parts() const
{
    return (Size + CardPartSize - 1) / CardPartSize;
}

std::uint64_t CardSummary::AllParts() const
{
    return Parts() >= MostCardParts ? ~std::uint64_t{0} : (std::uint64_t{1} << Parts()) - 1;
}

bool IsCardMessage(std::span<const std::uint8_t> datagram)
{
    return datagram.size() >= RtpsHeaderSize + SubmessageHeaderSize &&
           std::equal(Header.begin(), Header.end(), datagram.begin()) &&
           SubmessageKind{datagram[RtpsHeaderSize]} == Kind;
}

std::optional<CardMessage> ReadCardMessage(std::span<const std::uint8_t> datagram)
{
    constexpr std::uint8_t littleEndian = 0x01;
    if (!IsCardMessage(datagram) || datagram[RtpsHeaderSize + 1] != littleEndian)
    {
        return std::nullopt;
    }
    RtpsReader head(datagram.subspan(RtpsHeaderSize + 2), true);
    const std::size_t length = head.U16();
    RtpsReader body(head.Rest(), true);
    CardMessage message{.From = SenderOf(datagram)};
    const auto counts = body.Bytes(4);
    message.Summary.Digest = U64(body);
    message.Summary.Size = body.U32();
    message.SentAt = body.U32();
    if (!body.IsGood() || length != head.Left() || counts[0] != Format || counts[1] > MostCardRequests ||
        counts[3] > 1 || message.Summary.Size > LargestCard || message.From == GuidPrefix{})
    {
        return std::nullopt;
    }
    for (std::size_t i = 0; i < counts[1]; ++i)
    {
        CardRequest &request = message.Requests.emplace_back();
        const auto of = body.Bytes(request.Of.size());
        std::copy(of.begin(), of.end(), request.Of.begin());
        request.Parts = U64(body);
    }
    message.HasPart = counts[3] == 1;
    message.Part = counts[2];
    if (!body.IsGood() || (message.HasPart && message.Part >= message.Summary.Parts()))
    {
        return std::nullopt;
    }
    if (message.HasPart)
    {
        const auto from = body.Bytes(message.Answers.From.size());
        std::copy(from.begin(), from.end(), message.Answers.From.begin());
        message.Answers.SentAt = body.U32();
        message.Bytes = body.Bytes(SizeOfPart(message.Summary, message.Part));
    }
    return body.IsGood() && body.Left() < MostPadding ? std::optional(std::move(message)) : std::nullopt;
}

std::vector<std::uint8_t> WriteCardMessage(const CardMessage &message)
{
    constexpr std::uint8_t littleEndian = 0x01;
    const std::size_t unpadded = RequestsAt + RequestSize * message.Requests.size() +
                                 (message.HasPart ? AnswersSize + message.Bytes.size() : 0);
    const std::size_t length = (unpadded + Alignment - 1) / Alignment * Alignment;
    std::vector<std::uint8_t> bytes(RtpsHeaderSize + SubmessageHeaderSize + length);
    std::size_t at = 0;
    const auto add = [&](std::span<const std::uint8_t> added)
    {
        std::copy(added.begin(), added.end(), bytes.begin() + static_cast<std::ptrdiff_t>(at));
        at += added.size();
    };
    const auto addNumber = [&](std::uint64_t number, std::size_t size)
    {
        for (std::size_t i = 0; i < size; ++i)
        {
            bytes[at++] = static_cast<std::uint8_t>(number >> (8 * i));
        }
    };
    add(Header);
    add(message.From);
    addNumber(static_cast<std::uint8_t>(Kind), 1);
    addNumber(littleEndian, 1);
    addNumber(length, 2);
    addNumber(Format, 1);
    addNumber(message.Requests.size(), 1);
    addNumber(message.Part, 1);
    addNumber(message.HasPart ? 1 : 0, 1);
    addNumber(message.Summary.Digest, 8);
    addNumber(message.Summary.Size, 4);
    addNumber(message.SentAt, 4);
    for (const CardRequest &request : message.Requests)
    {
        add(request.Of);
        addNumber(request.Parts, 8);
    }
    if (message.HasPart)
    {
        add(message.Answers.From);
        addNumber(message.Answers.SentAt, 4);
        add(message.Bytes);
    }
    while (EndsLikeStatistics(bytes))
    {
        bytes.resize(bytes.size() + Alignment);
        const std::size_t padded = bytes.size() - RtpsHeaderSize - SubmessageHeaderSize;
        bytes[RtpsHeaderSize + 2] = static_cast<std::uint8_t>(padded);
        bytes[RtpsHeaderSize + 3] = static_cast<std::uint8_t>(padded >> 8);
    }
    return bytes;
}

std::size_t CardMessageSize(std::size_t requests, std::size_t part)
{
    return RtpsHeaderSize + SubmessageHeaderSize + RequestsAt + requests * RequestSize +
           (part > 0 ? AnswersSize + part : 0);
}

}  // namespace Rabit::Rtps
