#include "envelope/Claim.h"

#include <rabit/base/Assert.h>

#include <algorithm>

#include "common/RtpsWriter.h"
#include "envelope/Certificate.h"
#include "guard/RtpsMessage.h"

namespace Rabit::Envelope
{

namespace
{

constexpr std::uint8_t ClaimFormat = 1;

template <typename Field>
void TakeFields(std::span<const std::uint8_t> &rest, std::size_t count, std::vector<Field> &to)
{
    to.resize(count);
    for (Field &field : to)
    {
        std::copy_n(rest.begin(), field.size(), field.begin());
        rest = rest.subspan(field.size());
    }
}

}  // namespace

std::optional<Claim> ReadClaim(std::span<const std::uint8_t> bytes)
{
    if (bytes.size() < Claim::FixedSize || bytes[0] != ClaimFormat)
    {
        return std::nullopt;
    }
    const std::size_t headers = bytes[1];
    const std::size_t answers = bytes[2];
    if (headers == 0 || headers > Claim::MostHeaders || answers > Claim::MostAnswers)
    {
        return std::nullopt;
    }
    const std::size_t least = Claim::SizeWith(headers, answers, 0);
    if (bytes.size() < least || bytes.size() != least + bytes[least - 1] ||
        bytes[least - 1] > LargestCertificate)
    {
        return std::nullopt;
    }
    Claim claim;
    std::copy_n(bytes.begin() + 3, claim.Challenge.size(), claim.Challenge.begin());
    auto rest = bytes.subspan(Claim::FixedSize);
    TakeFields(rest, headers, claim.Headers);
    TakeFields(rest, answers, claim.Answers);
    claim.Certificate = rest.subspan(1);
    const bool areRtps = std::all_of(claim.Headers.begin(), claim.Headers.end(),
                                     [](const RtpsHeader &header) { return Rtps::HasRtpsHeader(header); });
    return areRtps ? std::optional(std::move(claim)) : std::nullopt;
}

std::vector<std::uint8_t> WriteClaim(const Claim &claim)
{
    RABIT_ASSERT(claim.Headers.size() <= Claim::MostHeaders && claim.Answers.size() <= Claim::MostAnswers &&
                 claim.Certificate.size() <= LargestCertificate);
    std::vector<std::uint8_t> bytes{ClaimFormat, static_cast<std::uint8_t>(claim.Headers.size()),
                                    static_cast<std::uint8_t>(claim.Answers.size())};
    Rtps::Append(bytes, claim.Challenge);
    for (const RtpsHeader &header : claim.Headers)
    {
        Rtps::Append(bytes, header);
    }
    for (const Nonce &answer : claim.Answers)
    {
        Rtps::Append(bytes, answer);
    }
    bytes.push_back(static_cast<std::uint8_t>(claim.Certificate.size()));
    Rtps::Append(bytes, claim.Certificate);
    return bytes;
}

}  // namespace Rabit::Envelope
