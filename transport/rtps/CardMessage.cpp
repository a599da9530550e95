#include "rtps/CardMessage.h"

#include <rabit/base/Assert.h>

#include <algorithm>
#include <array>

#include "common/RtpsReader.h"
#include "common/RtpsWriter.h"

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
    if (!IsCardMessage(datagram) || datagram[RtpsHeaderSize + 1] != LittleEndianFlag)
    {
        return std::nullopt;
    }
    RtpsReader head(datagram.subspan(RtpsHeaderSize + 2), true);
    const std::size_t length = head.U16();
    RtpsReader body(head.Rest(), true);
    CardMessage message{.From = SenderOf(datagram)};
    const auto counts = body.Bytes(4);
    message.Summary.Digest = body.U64();
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
        request.Of = body.Prefix();
        request.Parts = body.U64();
    }
    message.HasPart = counts[3] == 1;
    message.Part = counts[2];
    if (!body.IsGood() || (message.HasPart && message.Part >= message.Summary.Parts()))
    {
        return std::nullopt;
    }
    if (message.HasPart)
    {
        message.Answers.From = body.Prefix();
        message.Answers.SentAt = body.U32();
        message.Bytes = body.Bytes(SizeOfPart(message.Summary, message.Part));
    }
    return body.IsGood() && body.Left() < MostPadding ? std::optional(std::move(message)) : std::nullopt;
}

std::vector<std::uint8_t> WriteCardMessage(const CardMessage &message)
{
    RABIT_ASSERT(message.Requests.size() <= MostCardRequests && message.Summary.Size <= LargestCard);
    RABIT_ASSERT(!message.HasPart || message.Bytes.size() == SizeOfPart(message.Summary, message.Part));
    const std::size_t unpadded = RequestsAt + RequestSize * message.Requests.size() +
                                 (message.HasPart ? AnswersSize + message.Bytes.size() : 0);
    const std::size_t length = (unpadded + Alignment - 1) / Alignment * Alignment;
    std::vector<std::uint8_t> bytes;
    bytes.reserve(RtpsHeaderSize + SubmessageHeaderSize + length + MostPadding);
    Append(bytes, Header);
    Append(bytes, message.From);
    AppendSubmessageHeader(bytes, Kind, length);
    Append(bytes, Format, 1);
    Append(bytes, message.Requests.size(), 1);
    Append(bytes, message.Part, 1);
    Append(bytes, message.HasPart ? 1 : 0, 1);
    Append(bytes, message.Summary.Digest, 8);
    Append(bytes, message.Summary.Size, 4);
    Append(bytes, message.SentAt, 4);
    for (const CardRequest &request : message.Requests)
    {
        Append(bytes, request.Of);
        Append(bytes, request.Parts, 8);
    }
    if (message.HasPart)
    {
        Append(bytes, message.Answers.From);
        Append(bytes, message.Answers.SentAt, 4);
        Append(bytes, message.Bytes);
    }
    bytes.resize(RtpsHeaderSize + SubmessageHeaderSize + length);
    while (EndsLikeStatistics(bytes))
    {
        bytes.resize(bytes.size() + Alignment);
        Write(std::span(bytes).subspan(RtpsHeaderSize + 2, 2),
              bytes.size() - RtpsHeaderSize - SubmessageHeaderSize, true);
    }
    return bytes;
}

std::size_t CardMessageSize(std::size_t requests, std::size_t part)
{
    return RtpsHeaderSize + SubmessageHeaderSize + RequestsAt + requests * RequestSize +
           (part > 0 ? AnswersSize + part : 0);
}

}  // namespace Rabit::Rtps
