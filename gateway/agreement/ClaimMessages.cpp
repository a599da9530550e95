#include "agreement/ClaimMessages.h"

#include <rabit/base/LittleEndian.h>
#include <rabit/base/WireBytes.h>

#include <utility>

#include "agreement/AgreementSettings.h"

namespace Rabit
{
namespace
{

constexpr std::uint8_t RequestByte = 1;
constexpr std::uint8_t ReplyByte = 2;
constexpr std::size_t LongestNode = 200;

}  // namespace

std::vector<std::uint8_t> EncodeClaimRequest(const ClaimRequest &request)
{
    using LittleEndian::Put;
    std::vector<std::uint8_t> bytes{RequestByte};
    Put(request.Group, bytes);
    Put(request.Incarnation, bytes);
    Put(request.Session, bytes);
    Put(request.Renewal, bytes);
    Put(request.Book, bytes);
    Put(request.Number, bytes);
    bytes.push_back(static_cast<std::uint8_t>(request.Orders.size()));
    for (const ClaimOrder &order : request.Orders)
    {
        bytes.push_back(static_cast<std::uint8_t>(order.What));
        Put(order.Fence, bytes);
        PutName(order.Name, bytes);
    }
    return bytes;
}

std::vector<std::uint8_t> EncodeClaimReply(const ClaimReply &reply)
{
    using LittleEndian::Put;
    std::vector<std::uint8_t> bytes{ReplyByte};
    Put(reply.Group, bytes);
    Put(reply.Incarnation, bytes);
    Put(reply.Claimant, bytes);
    Put(reply.Session, bytes);
    Put(reply.Book, bytes);
    Put(reply.Renewal, bytes);
    Put(reply.Number, bytes);
    Put(reply.Fences, bytes);
    bytes.push_back(static_cast<std::uint8_t>(reply.Results.size()));
    for (const ClaimResult &result : reply.Results)
    {
        bytes.push_back(static_cast<std::uint8_t>(result.What));
        Put(result.Milliseconds, bytes);
        PutName(result.Name, bytes);
        PutName(result.Holder, bytes);
    }
    return bytes;
}

std::optional<ClaimRequest> DecodeClaimRequest(std::span<const std::uint8_t> bytes)
{
    WireReader from(bytes);
    if (from.Byte() != RequestByte)
    {
        return std::nullopt;
    }
    ClaimRequest request;
    request.Group = from.Fixed<std::uint64_t>();
    request.Incarnation = from.Fixed<std::uint64_t>();
    request.Session = from.Fixed<std::uint32_t>();
    request.Renewal = from.Fixed<std::uint32_t>();
    request.Book = from.Fixed<std::uint64_t>();
    request.Number = from.Fixed<std::uint32_t>();
    request.Orders.resize(from.Byte(ClaimRequest::MostOrders));
    for (ClaimOrder &order : request.Orders)
    {
        order.What = from.Enumerator(ClaimOrder::Kind::Release);
        order.Fence = from.Fixed<std::uint64_t>();
        order.Name = from.Name(1, AgreementSettings::LongestName);
    }
    return from.IsAtEnd() ? std::optional(std::move(request)) : std::nullopt;
}

std::optional<ClaimReply> DecodeClaimReply(std::span<const std::uint8_t> bytes)
{
    WireReader from(bytes);
    if (from.Byte() != ReplyByte)
    {
        return std::nullopt;
    }
    ClaimReply reply;
    reply.Group = from.Fixed<std::uint64_t>();
    reply.Incarnation = from.Fixed<std::uint64_t>();
    reply.Claimant = from.Fixed<std::uint64_t>();
    reply.Session = from.Fixed<std::uint32_t>();
    reply.Book = from.Fixed<std::uint64_t>();
    reply.Renewal = from.Fixed<std::uint32_t>();
    reply.Number = from.Fixed<std::uint32_t>();
    reply.Fences = from.Fixed<std::uint64_t>();
    reply.Results.resize(from.Byte(ClaimRequest::MostOrders));
    for (ClaimResult &result : reply.Results)
    {
        result.What = from.Enumerator(ClaimResult::Kind::Refused);
        result.Milliseconds = from.Fixed<std::uint32_t>();
        result.Name = from.Name(1, AgreementSettings::LongestName);
        result.Holder = from.Name(0, LongestNode);
    }
    return from.IsAtEnd() ? std::optional(std::move(reply)) : std::nullopt;
}

}  // namespace Rabit
