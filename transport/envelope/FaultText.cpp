#include "envelope/FaultText.h"

#include <cstddef>

#include "guard/RtpsMessage.h"

namespace Rabit::Envelope
{

namespace
{

// A program with this vendor only looks who is there, as `rabit doctor` does: it is no program that should
// have keys.
bool IsOfNoVendor(std::span<const std::uint8_t> message)
{
    constexpr std::size_t vendorAt = 6;
    return message[vendorAt] == 0 && message[vendorAt + 1] == 0;
}

// Follows the sender's name or address. Empty if nothing is wrong with the sender.
std::string WrongWith(OpenFault fault, std::span<const std::uint8_t> datagram, Epoch in, Epoch newest)
{
    switch (fault)
    {
        case OpenFault::Malformed:
            return Rtps::HasRtpsHeader(datagram) && !IsOfNoVendor(datagram)
                       ? ": a program without keys sends there, and is not heard; give it keys, or end it"
                       : "";
        case OpenFault::UnknownEpoch:
            return in > newest ? ": it sends in epoch " + std::to_string(in) +
                                     ", but this node lacks that bulletin; it asks for it"
                               : ": it sends in epoch " + std::to_string(in) +
                                     ", which this node does not know; bring it the newest bulletin";
        case OpenFault::Revoked:
            return ": its certificate is revoked, and it is not heard; make new keys for it";
        case OpenFault::NotAuthentic:
            return ": its datagrams do not open: it has keys of another fleet, or they are damaged";
        case OpenFault::BadSignature:
            return ": its datagrams were made by another member than they say";
        case OpenFault::BadCertificate:
            return ": another authority signed its certificate";
        case OpenFault::ForeignSource:
            return ": it sends in the name of other participants";
        case OpenFault::OpenSslFailed:
            return ": OpenSSL failed at its datagrams";
        default:
            return "";
    }
}

// For example 10.0.0.9.
std::string AddressText(const Rtps::HostAddress &host)
{
    std::string text;
    for (const std::uint8_t byte : host)
    {
        text += (text.empty() ? "" : ".") + std::to_string(byte);
    }
    return text;
}

ProblemKind KindOf(OpenFault fault)
{
    return fault == OpenFault::Malformed      ? ProblemKind::WithoutKeys
           : fault == OpenFault::UnknownEpoch ? ProblemKind::UnknownEpoch
                                              : ProblemKind::Usual;
}

}  // namespace

const char *TextOf(SealFault fault)
{
    switch (fault)
    {
        case SealFault::None:
            return "";
        case SealFault::NotOurs:
            return "it begins with another participant's RTPS header";
        case SealFault::TooLarge:
            return "sealed, it would be larger than a datagram; make max_datagram smaller";
        case SealFault::NoRoom:
            return "there is no room to seal it";
        case SealFault::NoEpoch:
            return "the epoch's secret is not known";
        case SealFault::NumbersEnded:
            return "the session has used up its numbers; start the node anew";
        case SealFault::EndsLikeStatistics:
            return "it ends like statistics of Fast DDS, whatever is tried";
        case SealFault::OpenSslFailed:
            return "OpenSSL failed";
    }
    return "";
}

std::string TextOf(NodeVoices::Verdict verdict, const std::string &name)
{
    return verdict == NodeVoices::Verdict::TwoCertificates
               ? "two certificates have the name " + name + ", and both are in use"
               : name + " is live twice: its keys are on two hosts, or it was started twice";
}

FaultRow RowOf(const Opener::Result &result, std::span<const std::uint8_t> datagram, Epoch in, Epoch newest,
               const Rtps::HostAddress &from)
{
    const std::string text = WrongWith(result.Fault, datagram, in, newest);
    if (text.empty())
    {
        return {};
    }
    const bool isNamed = result.Fault == OpenFault::Revoked && result.Sender != nullptr;
    const std::string entry = isNamed ? result.Sender->Certificate().Content.Name : AddressText(from);
    return {.Entry = entry, .Text = entry + text, .Kind = KindOf(result.Fault)};
}

}  // namespace Rabit::Envelope
