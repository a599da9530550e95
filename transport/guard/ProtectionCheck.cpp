#include "guard/ProtectionCheck.h"

#include "common/RtpsReader.h"
#include "guard/DeliveryCheck.h"

namespace Rabit::Rtps
{

namespace
{

// 9.5.2.3 and 9.5.3.3.1: kind and number of the key, a session, and the rest of the initialization vector.
bool IsPrefix(const Submessage &submessage)
{
    constexpr std::size_t CryptoHeaderSize = 20;
    return submessage.Body().size() == CryptoHeaderSize;
}

// Encrypted content, preceded by its own length.
bool IsSealed(const Submessage &submessage)
{
    RtpsReader body(submessage.Body(), false);
    const std::uint32_t size = body.U32();
    return body.IsGood() && size <= body.Left() && body.Left() - size < 4;
}

// True if the vendor may see this submessage between a prefix and a postfix, where all ends are known.
bool IsContent(const Submessage &submessage)
{
    return submessage.Kind != SubmessageKind{0} && !IsSecure(submessage.Kind) &&
           submessage.Kind < SubmessageKind::Statistics;
}

// True for a submessage of a writer or a reader, and for the INFO_TS that Fast DDS signs by itself. An
// INFO_SRC here would also be obeyed: the key of one writer would begin to speak for another participant.
bool IsOfGroup(const Submessage &submessage)
{
    return IsDelivery(submessage.Kind) || submessage.Kind == SubmessageKind::InfoTimestamp;
}

// A common tag, and one for each receiver that has its own.
bool IsPostfix(const Submessage &submessage)
{
    const bool endsWithTheDatagram = submessage.Whole[2] == 0 && submessage.Whole[3] == 0;
    if (endsWithTheDatagram)
    {
        return false;  // the vendor takes it for empty
    }
    constexpr std::size_t TagSize = 16;
    constexpr std::size_t ReceiverTagSize = 4 + TagSize;
    RtpsReader body(submessage.Body(), false);
    body.Skip(TagSize);
    const std::uint32_t receivers = body.U32();
    return body.IsGood() && body.Left() % ReceiverTagSize == 0 && body.Left() / ReceiverTagSize == receivers;
}

// Takes the single submessage between a prefix and a postfix, and the postfix.
bool TakeContent(std::span<std::uint8_t> &rest)
{
    if (rest.empty())
    {
        return false;
    }
    const auto content = TakeSubmessage(rest);
    if (!content || rest.empty() ||
        (content->Kind == SubmessageKind::SecureBody ? !IsSealed(*content) : !IsOfGroup(*content)))
    {
        return false;
    }
    const auto postfix = TakeSubmessage(rest);
    return postfix && postfix->Kind == SubmessageKind::SecurePostfix && IsPostfix(*postfix);
}

// Takes everything between the prefix of a message and its postfix, and the postfix. Only statistics may
// follow.
bool TakeMessage(std::span<std::uint8_t> &rest, const std::function<bool(const Submessage &)> &mayContain)
{
    for (bool first = true; !rest.empty(); first = false)
    {
        const auto submessage = TakeSubmessage(rest);
        if (!submessage)
        {
            return false;
        }
        switch (submessage->Kind)
        {
            case SubmessageKind::SecureBody:
            {
                if (!first || !IsSealed(*submessage) || rest.empty() || !mayContain(*submessage))
                {
                    return false;
                }
                const auto postfix = TakeSubmessage(rest);
                return postfix && postfix->Kind == SubmessageKind::MessagePostfix && IsPostfix(*postfix);
            }
            case SubmessageKind::SecurePrefix:
                if (!IsPrefix(*submessage) || !TakeContent(rest))
                {
                    return false;
                }
                break;
            case SubmessageKind::MessagePostfix:
                return !first && IsPostfix(*submessage);
            default:
                if (!IsContent(*submessage) || !mayContain(*submessage))
                {
                    return false;
                }
                break;
        }
    }
    return false;
}

}  // namespace

std::optional<std::size_t> ProtectedSize(std::span<std::uint8_t> from, bool wholeMessage,
                                         const std::function<bool(const Submessage &)> &mayContain)
{
    auto rest = from;
    const auto prefix = TakeSubmessage(rest);
    if (!prefix || !IsPrefix(*prefix))
    {
        return std::nullopt;
    }
    const bool sound = prefix->Kind == SubmessageKind::SecurePrefix || !wholeMessage
                           ? prefix->Kind == SubmessageKind::SecurePrefix && TakeContent(rest)
                           : prefix->Kind == SubmessageKind::MessagePrefix && TakeMessage(rest, mayContain);
    return sound ? std::optional(from.size() - rest.size()) : std::nullopt;
}

}  // namespace Rabit::Rtps
