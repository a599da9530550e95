#include "guard/ProtectionCheck.h"

#include <algorithm>

#include "common/RtpsReader.h"
#include "guard/DeliveryCheck.h"

namespace Rabit::Rtps
{

namespace
{

constexpr std::size_t KeyNumberSize = 4;

// True for the number 0, which no key of a writer, a participant or a receiver has.
bool IsZero(std::span<const std::uint8_t> keyNumber)
{
    return std::all_of(keyNumber.begin(), keyNumber.end(), [](std::uint8_t byte) { return byte == 0; });
}

// 9.5.2.3 and 9.5.3.3.1: kind and number of the key, a session, and the rest of the initialization vector.
bool IsPrefix(const Submessage &submessage)
{
    constexpr std::size_t CryptoHeaderSize = 20;
    return submessage.Body().size() == CryptoHeaderSize;
}

// Requires IsPrefix.
std::span<const std::uint8_t> KeyNumberOf(const Submessage &prefix)
{
    constexpr std::size_t KindSize = 4;
    return prefix.Body().subspan(KindSize, KeyNumberSize);
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

// A common tag, and one for each receiver that has its own. Proof::OfSender: there is at least one of these.
bool IsPostfix(const Submessage &submessage, Proof proof)
{
    const bool endsWithTheDatagram = submessage.Whole[2] == 0 && submessage.Whole[3] == 0;
    if (endsWithTheDatagram)
    {
        return false;  // the vendor takes it for empty
    }
    constexpr std::size_t TagSize = 16;
    constexpr std::size_t ReceiverTagSize = KeyNumberSize + TagSize;
    RtpsReader body(submessage.Body(), false);
    body.Skip(TagSize);
    const std::uint32_t receivers = body.U32();
    if (!body.IsGood() || body.Left() % ReceiverTagSize != 0 || body.Left() / ReceiverTagSize != receivers)
    {
        return false;
    }
    bool proves = proof == Proof::OfMember || receivers > 0;
    while (proves && proof == Proof::OfSender && body.Left() > 0)
    {
        proves = !IsZero(body.Bytes(KeyNumberSize));
        body.Skip(TagSize);
    }
    return proves;
}

// Takes the single submessage between a prefix and a postfix, and the postfix. The message around it or its
// key tells the sender.
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
    return postfix && postfix->Kind == SubmessageKind::SecurePostfix && IsPostfix(*postfix, Proof::OfMember);
}

// Takes everything between the prefix of a message and its postfix, and the postfix. Only statistics may
// follow.
bool TakeMessage(std::span<std::uint8_t> &rest, Proof proof,
                 const std::function<bool(const Submessage &)> &mayContain)
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
                return postfix && postfix->Kind == SubmessageKind::MessagePostfix &&
                       IsPostfix(*postfix, proof);
            }
            case SubmessageKind::SecurePrefix:
                if (!IsPrefix(*submessage) || !TakeContent(rest))
                {
                    return false;
                }
                break;
            case SubmessageKind::MessagePostfix:
                return !first && IsPostfix(*submessage, proof);
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

std::optional<std::size_t> ProtectedSize(std::span<std::uint8_t> from, bool wholeMessage, Proof proof,
                                         const std::function<bool(const Submessage &)> &mayContain)
{
    auto rest = from;
    const auto prefix = TakeSubmessage(rest);
    if (!prefix || !IsPrefix(*prefix))
    {
        return std::nullopt;
    }
    bool sound = false;
    if (prefix->Kind == SubmessageKind::SecurePrefix)
    {
        sound = (proof == Proof::OfMember || IsZero(KeyNumberOf(*prefix))) && TakeContent(rest);
    }
    else if (prefix->Kind == SubmessageKind::MessagePrefix && wholeMessage)
    {
        sound = TakeMessage(rest, proof, mayContain);
    }
    return sound ? std::optional(from.size() - rest.size()) : std::nullopt;
}

}  // namespace Rabit::Rtps
