#include "envelope/BlobMessage.h"

#include <rabit/base/Assert.h>

#include <algorithm>

#include "common/RtpsReader.h"
#include "common/RtpsWriter.h"

namespace Rabit::Envelope
{

namespace
{

constexpr auto BlobSubmessage = static_cast<Rtps::SubmessageKind>(0xd3);
constexpr std::uint8_t BlobFormat = 1;
constexpr std::size_t BlobAlignment = 4;

// The bytes of the part with that index; 0: there is no such part.
std::size_t SizeOfBlobPart(std::size_t size, std::size_t index)
{
    return index >= BlobPartsOf(size) ? 0 : std::min(BlobPartSize, size - index * BlobPartSize);
}

Hash TakeHash(Rtps::RtpsReader &body)
{
    Hash hash{};
    const auto bytes = body.Bytes(hash.size());
    std::copy(bytes.begin(), bytes.end(), hash.begin());
    return hash;
}

std::optional<BlobPart> TakeBlobPart(Rtps::RtpsReader &body)
{
    BlobPart part;
    const auto front = body.Bytes(4);
    part.Size = body.U32();
    part.Of = TakeHash(body);
    if (!body.IsGood() || front[0] >= BlobKinds || part.Size > LargestBlob)
    {
        return std::nullopt;
    }
    part.Kind = BlobKind{front[0]};
    part.Index = front[1];
    part.Bytes = body.Bytes(SizeOfBlobPart(part.Size, part.Index));
    return body.IsGood() && !part.Bytes.empty() ? std::optional(part) : std::nullopt;
}

}  // namespace

std::optional<BlobMessage> ReadBlobMessage(std::span<const std::uint8_t> message)
{
    constexpr std::size_t BodyAt = Rtps::RtpsHeaderSize + Rtps::SubmessageHeaderSize;
    if (message.size() < BodyAt || Rtps::SubmessageKind{message[Rtps::RtpsHeaderSize]} != BlobSubmessage ||
        message[Rtps::RtpsHeaderSize + 1] != Rtps::LittleEndianFlag)
    {
        return std::nullopt;
    }
    Rtps::RtpsReader head(message.subspan(Rtps::RtpsHeaderSize + 2), true);
    const std::size_t length = head.U16();
    if (length > head.Left())
    {
        return std::nullopt;
    }
    // Behind the submessage there may be padding (Sealer.h).
    Rtps::RtpsReader body(head.Rest().first(length), true);
    const auto counts = body.Bytes(4);
    if (!body.IsGood() || counts[0] != BlobFormat || counts[1] > MostBlobRequests || counts[2] > 1)
    {
        return std::nullopt;
    }
    BlobMessage read;
    for (std::size_t i = 0; i < counts[1]; ++i)
    {
        BlobRequest &request = read.Requests.emplace_back();
        request.Of = body.U32();
        request.Wanted = TakeHash(body);
        request.Parts = body.U64();
    }
    if (counts[2] == 1)
    {
        read.Part = TakeBlobPart(body);
        if (!read.Part)
        {
            return std::nullopt;
        }
    }
    return body.IsGood() && body.Left() < BlobAlignment ? std::optional(std::move(read)) : std::nullopt;
}

std::vector<std::uint8_t> WriteBlobMessage(const RtpsHeader &own, const BlobMessage &message)
{
    RABIT_ASSERT(message.Requests.size() <= MostBlobRequests);
    RABIT_ASSERT(!message.Part ||
                 message.Part->Bytes.size() == SizeOfBlobPart(message.Part->Size, message.Part->Index));
    std::vector<std::uint8_t> body;
    Rtps::Append(body, BlobFormat, 1);
    Rtps::Append(body, message.Requests.size(), 1);
    Rtps::Append(body, message.Part ? 1 : 0, 1);
    Rtps::Append(body, 0, 1);
    for (const BlobRequest &request : message.Requests)
    {
        Rtps::Append(body, request.Of, sizeof request.Of);
        Rtps::Append(body, request.Wanted);
        Rtps::Append(body, request.Parts, sizeof request.Parts);
    }
    if (message.Part)
    {
        Rtps::Append(body, static_cast<std::uint8_t>(message.Part->Kind), 1);
        Rtps::Append(body, message.Part->Index, 1);
        Rtps::Append(body, 0, 2);
        Rtps::Append(body, message.Part->Size, 4);
        Rtps::Append(body, message.Part->Of);
        Rtps::Append(body, message.Part->Bytes);
    }
    body.resize((body.size() + BlobAlignment - 1) / BlobAlignment * BlobAlignment);
    std::vector<std::uint8_t> bytes(own.begin(), own.end());
    Rtps::AppendSubmessageHeader(bytes, BlobSubmessage, body.size());
    Rtps::Append(bytes, body);
    return bytes;
}

}  // namespace Rabit::Envelope
