#include "envelope/Sealer.h"

#include <algorithm>
#include <array>
#include <limits>

#include "common/RtpsReader.h"
#include "guard/RtpsMessage.h"

namespace Rabit::Envelope
{

namespace
{

constexpr std::array<std::uint8_t, Sealer::PadSize> PadSubmessage = {
    static_cast<std::uint8_t>(Rtps::SubmessageKind::Pad), Rtps::LittleEndianFlag, 0, 0};
constexpr std::size_t PadRoom = (Sealer::MostTries - 1) * Sealer::PadSize;

}  // namespace

bool LooksLikeStatistics(std::span<const std::uint8_t> datagram)
{
    return datagram.size() >= Rtps::StatisticsSize &&
           Rtps::SubmessageKind{datagram[datagram.size() - Rtps::StatisticsSize]} ==
               Rtps::SubmessageKind::Statistics;
}

Sealer::Sealer(Self &self, const EpochSecrets &epochs)
    : _self(self),
      _epochs(epochs),
      _tag(TagOf(self.Own)),
      _work(OuterContextSize + LargestDatagram + PadRoom + sizeof(Signature))
{
}

Sealer::Result Sealer::SealGroup(std::span<const std::uint8_t> message, OuterClass contents,
                                 std::span<std::uint8_t> out, std::optional<Epoch> epoch)
{
    const Epoch in = epoch.value_or(_epochs.Newest());
    if (!MaySealIn(in, contents))
    {
        return {.Fault = SealFault::NoEpoch};
    }
    return SealMessage(message, {.Kind = OuterKind::Group, .Contents = contents, .Epoch = in}, out);
}

Sealer::Result Sealer::SealPairwise(std::span<const std::uint8_t> message, OuterClass contents,
                                    const Receiver &to, std::span<std::uint8_t> out)
{
    if (!MaySealIn(to.Epoch, contents))
    {
        return {.Fault = SealFault::NoEpoch};
    }
    return SealMessage(message,
                       {.Kind = OuterKind::Pairwise,
                        .Contents = contents,
                        .Epoch = to.Epoch,
                        .Receiver = to.Of.Session,
                        .Key = &to.Key},
                       out);
}

bool Sealer::MaySealIn(Epoch epoch, OuterClass contents) const
{
    return epoch != 0 && (epoch == _epochs.Newest() || contents == OuterClass::Bulletin);
}

Sealer::Result Sealer::SealClaim(const Nonce &challenge, std::span<const Nonce> answers, bool withCertificate,
                                 std::span<std::uint8_t> out, std::optional<Epoch> epoch)
{
    Claim claim{.Challenge = challenge, .Headers = _self.Headers};
    claim.Answers.assign(answers.begin(), answers.begin() + static_cast<std::ptrdiff_t>(std::min(
                                                                answers.size(), Claim::MostAnswers)));
    if (withCertificate)
    {
        claim.Certificate = _self.Certificate;
    }
    const std::vector<std::uint8_t> plain = WriteClaim(claim);
    std::copy(plain.begin(), plain.end(), _work.begin() + OuterContextSize);
    return SealTries({.Kind = OuterKind::Claim,
                      .Contents = OuterClass::Meeting,
                      .Epoch = epoch.value_or(_epochs.Newest())},
                     plain.size(), out);
}

Sealer::Result Sealer::SealMessage(std::span<const std::uint8_t> message, Request request,
                                   std::span<std::uint8_t> out)
{
    const auto header = std::find_if(
        _self.Headers.begin(), _self.Headers.end(),
        [message](const RtpsHeader &each)
        { return message.size() >= each.size() && std::equal(each.begin(), each.end(), message.begin()); });
    if (header == _self.Headers.end())
    {
        return {.Fault = SealFault::NotOurs};
    }
    const auto rest = message.subspan(header->size());
    if (rest.size() + OuterOverhead(request.Kind) > LargestDatagram)
    {
        return {.Fault = SealFault::TooLarge};
    }
    request.Header = static_cast<std::uint8_t>(header - _self.Headers.begin());
    std::copy(rest.begin(), rest.end(), _work.begin() + OuterContextSize);
    return SealTries(request, rest.size(), out);
}

Sealer::Result Sealer::SealTries(const Request &request, std::size_t size, std::span<std::uint8_t> out)
{
    Request sealed = request;
    if (sealed.Key == nullptr)
    {
        sealed.Key = OwnGroupKey(request.Epoch);
    }
    if (sealed.Key == nullptr)
    {
        return {.Fault =
                    _epochs.Secret(request.Epoch) == nullptr ? SealFault::NoEpoch : SealFault::OpenSslFailed};
    }
    const std::size_t overhead = OuterOverhead(request.Kind);
    for (std::size_t tries = 0; tries < MostTries; ++tries)
    {
        if (size + overhead > out.size())
        {
            return {.Fault = SealFault::NoRoom};
        }
        // The last number is left out, so that the next one is never below it.
        if (_self.Next == std::numeric_limits<std::uint64_t>::max())
        {
            return {.Fault = SealFault::NumbersEnded};
        }
        const std::uint64_t number = _self.Next++;
        const auto datagram = out.first(size + overhead);
        if (const SealFault fault = SealOnce(sealed, number, size, datagram); fault != SealFault::None)
        {
            return {.Fault = fault};
        }
        if (!LooksLikeStatistics(datagram))
        {
            return {.Size = datagram.size()};
        }
        // The next number makes other bytes. Padding moves those that it does not change: the outer header.
        if (request.Kind != OuterKind::Claim && size + PadSize + overhead <= LargestDatagram && MayPad(size))
        {
            std::copy(PadSubmessage.begin(), PadSubmessage.end(),
                      _work.begin() + static_cast<std::ptrdiff_t>(OuterContextSize + size));
            size += PadSize;
        }
    }
    return {.Fault = SealFault::EndsLikeStatistics};
}

// A submessage of the length 0 extends to the end (RTPS 2.3, 9.4.5.1.3): it would swallow what is behind it.
// So would a damaged last one. The next submessage begins at a multiple of 4.
bool Sealer::MayPad(std::size_t size) const
{
    if (size % 4 != 0)
    {
        return false;
    }
    bool ends = size == 0;
    // The walk begins behind a header, for which the end of the context stands.
    const auto message = std::span(_work).subspan(RtpsHeaderInContext, Rtps::RtpsHeaderSize + size);
    Rtps::VisitSubmessages(
        message,
        [&](const Rtps::ConstSubmessage &part)
        {
            const std::size_t length = Rtps::RtpsReader(part.Whole.subspan(2), part.LittleEndian).U16();
            const bool isEmpty =
                part.Kind == Rtps::SubmessageKind::Pad || part.Kind == Rtps::SubmessageKind::InfoTimestamp;
            ends = (length > 0 || isEmpty) && part.Whole.size() == Rtps::SubmessageHeaderSize + length &&
                   part.Whole.data() + part.Whole.size() == message.data() + message.size();
        });
    return ends;
}

SealFault Sealer::SealOnce(const Request &request, std::uint64_t number, std::size_t size,
                           std::span<std::uint8_t> out)
{
    const auto low = static_cast<std::uint32_t>(number);
    WriteOuter({.Kind = request.Kind,
                .Class = request.Contents,
                .Header = request.Header,
                .Epoch = request.Epoch,
                .Tag = _tag,
                .Number = low},
               out);
    std::size_t front = OuterSize;
    const bool isClaim = request.Kind == OuterKind::Claim;
    if (isClaim)
    {
        WriteIntroduction(_self.Own, static_cast<std::uint32_t>(number >> 32), out.subspan(front));
        front += IntroductionSize;
    }
    const auto context = std::span(_work).first(OuterContextSize);
    WriteOuterContext(out, number, _self.Own, request.Receiver,
                      isClaim ? RtpsHeader{} : _self.Headers[request.Header], context);
    std::size_t plain = size;
    if (request.Kind != OuterKind::Pairwise)
    {
        const auto signature = _self.Signing.Sign(std::span(_work).first(OuterContextSize + size));
        if (!signature)
        {
            return SealFault::OpenSslFailed;
        }
        std::copy(signature->begin(), signature->end(),
                  _work.begin() + static_cast<std::ptrdiff_t>(OuterContextSize + size));
        plain += signature->size();
    }
    const bool good = _aead.Seal(*request.Key, number, context,
                                 std::span(_work).subspan(OuterContextSize, plain), out.subspan(front));
    return good ? SealFault::None : SealFault::OpenSslFailed;
}

const SecretKey *Sealer::OwnGroupKey(Epoch epoch)
{
    const SecretKey *const secret = _epochs.Secret(epoch);
    if (secret == nullptr)
    {
        return nullptr;
    }
    if (!_key || _keyEpoch != epoch)
    {
        _key = GroupKey(*secret, epoch, _self.Own);
        _keyEpoch = epoch;
    }
    return _key ? &*_key : nullptr;
}

}  // namespace Rabit::Envelope
