#include "envelope/Certificate.h"

#include <rabit/base/LittleEndian.h>

#include <algorithm>
#include <string_view>

#include "common/RtpsWriter.h"

namespace Rabit::Envelope
{

namespace
{

constexpr std::string_view CertificateLabel = "Rabit certificate 1";
constexpr std::uint8_t CertificateFormat = 1;
constexpr std::size_t FixedCertificateSize = 111;  // up to the name
static_assert(FixedCertificateSize + LongestCertificateName + sizeof(Signature) <= LargestCertificate);

bool IsCertificateName(std::string_view name)
{
    const auto isGood = [](char c)
    {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' ||
               c == '_' || c == '-';
    };
    return !name.empty() && name.size() <= LongestCertificateName &&
           std::all_of(name.begin(), name.end(), isGood);
}

std::vector<std::uint8_t> LabelledCertificate(std::span<const std::uint8_t> content)
{
    std::vector<std::uint8_t> labelled(CertificateLabel.begin(), CertificateLabel.end());
    Rtps::Append(labelled, content);
    return labelled;
}

template <std::size_t Size>
std::array<std::uint8_t, Size> TakeField(std::span<const std::uint8_t> &rest)
{
    std::array<std::uint8_t, Size> field{};
    std::copy_n(rest.begin(), Size, field.begin());
    rest = rest.subspan(Size);
    return field;
}

}  // namespace

std::vector<std::uint8_t> WriteCertificate(const Certificate &certificate, SigningKey &authority)
{
    if (!IsCertificateName(certificate.Name))
    {
        return {};
    }
    std::vector<std::uint8_t> bytes{CertificateFormat, static_cast<std::uint8_t>(certificate.Role)};
    LittleEndian::Put(certificate.Number, bytes);
    LittleEndian::Put(certificate.Begins, bytes);
    LittleEndian::Put(certificate.Ends, bytes);
    for (const PublicKey *key : {&certificate.Signing, &certificate.Agreement, &certificate.Permissions})
    {
        Rtps::Append(bytes, *key);
    }
    bytes.push_back(static_cast<std::uint8_t>(certificate.Name.size()));
    Rtps::Append(bytes, std::span(reinterpret_cast<const std::uint8_t *>(certificate.Name.data()),
                                  certificate.Name.size()));
    const auto signature = authority.Sign(LabelledCertificate(bytes));
    if (!signature)
    {
        return {};
    }
    Rtps::Append(bytes, *signature);
    return bytes;
}

std::optional<Certificate> ReadCertificate(std::span<const std::uint8_t> bytes)
{
    if (bytes.size() < FixedCertificateSize || bytes[0] != CertificateFormat ||
        bytes[1] > static_cast<std::uint8_t>(CertificateRole::Tool))
    {
        return std::nullopt;
    }
    const std::size_t length = bytes[FixedCertificateSize - 1];
    if (length > LongestCertificateName || bytes.size() != FixedCertificateSize + length + sizeof(Signature))
    {
        return std::nullopt;
    }
    Certificate certificate;
    certificate.Role = CertificateRole{bytes[1]};
    auto rest = bytes.subspan(2);
    certificate.Number = LittleEndian::Take<Serial>(rest);
    certificate.Begins = LittleEndian::Take<std::uint32_t>(rest);
    certificate.Ends = LittleEndian::Take<std::uint32_t>(rest);
    certificate.Signing = TakeField<sizeof(PublicKey)>(rest);
    certificate.Agreement = TakeField<sizeof(PublicKey)>(rest);
    certificate.Permissions = TakeField<sizeof(Hash)>(rest);
    certificate.Name.assign(reinterpret_cast<const char *>(rest.data()) + 1, length);
    return IsCertificateName(certificate.Name) ? std::optional(std::move(certificate)) : std::nullopt;
}

bool IsCertifiedBy(std::span<const std::uint8_t> bytes, VerifyingKey &authority)
{
    if (bytes.size() < sizeof(Signature))
    {
        return false;
    }
    return authority.Verify(LabelledCertificate(bytes.first(bytes.size() - sizeof(Signature))),
                            bytes.last(sizeof(Signature)));
}

}  // namespace Rabit::Envelope
