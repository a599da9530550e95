#include "agreement/ClaimMessages.h"

#include <rabit/base/LittleEndian.h>

#include <utility>

#include "agreement/AgreementBytes.h"
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
    AgreementBytes from(bytes);
    if (from.Take<std::uint8_t>() != RequestByte)
    {
        return std::nullopt;
    }
    ClaimRequest request;
    request.Group = from.Take<std::uint64_t>();
    request.Incarnation = from.Take<std::uint64_t>();
    request.Session = from.Take<std::uint32_t>();
    request.Renewal = from.Take<std::uint32_t>();
    request.Book = from.Take<std::uint64_t>();
    request.Number = from.Take<std::uint32_t>();
    request.Orders.resize(from.Count(ClaimRequest::MostOrders));
    for (ClaimOrder &order : request.Orders)
    {
        order.What = from.TakeKind(ClaimOrder::Kind::Release);
        order.Fence = from.Take<std::uint64_t>();
        order.Name = from.FilledName(AgreementSettings::LongestName);
    }
    return from.IsAtEnd() ? std::optional(std::move(request)) : std::nullopt;
}

std::optional<ClaimReply> DecodeClaimReply(std::span<const std::uint8_t> bytes)
{
    AgreementBytes from(bytes);
    if (from.Take<std::uint8_t>() != ReplyByte)
    {
        return std::nullopt;
    }
    ClaimReply reply;
    reply.Group = from.Take<std::uint64_t>();
    reply.Incarnation = from.Take<std::uint64_t>();
    reply.Claimant = from.Take<std::uint64_t>();
    reply.Session = from.Take<std::uint32_t>();
    reply.Book = from.Take<std::uint64_t>();
    reply.Renewal = from.Take<std::uint32_t>();
    reply.Number = from.Take<std::uint32_t>();
    reply.Fences = from.Take<std::uint64_t>();
    reply.Results.resize(from.Count(ClaimRequest::MostOrders));
    for (ClaimResult &result : reply.Results)
    {
        result.What = from.TakeKind(ClaimResult::Kind::Refused);
        result.Milliseconds = from.Take<std::uint32_t>();
        result.Name = from.FilledName(AgreementSettings::LongestName);
        result.Holder = from.Name(LongestNode);
    }
    return from.IsAtEnd() ? std::optional(std::move(reply)) : std::nullopt;
}

}  // namespace Rabit
