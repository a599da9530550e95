#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "envelope/AgreementKey.h"
#include "envelope/Certificate.h"
#include "envelope/Claim.h"
#include "envelope/KeyDerivation.h"
#include "envelope/SigningKey.h"

namespace Rabit::Envelope
{

// This node in one session: one opening, on one path. One thread may seal while another opens, each under a
// lock of its own. The lock of sealing guards `Signing` and `Next`; the lock of opening guards `Agreement`.
// Nothing else changes after the start.
struct Self
{
    SigningKey Signing;
    AgreementKey Agreement;
    // Random for each session: a session that comes twice would use nonces twice.
    End Own;
    std::vector<std::uint8_t> Certificate;
    // Each datagram of this session begins with one of these, at most four: the vendor's, and our own.
    std::vector<RtpsHeader> Headers;
    // The number of the next datagram: one space for all kinds and receivers, so that no key sees one twice.
    std::uint64_t Next = 0;

    // Empty if the certificate is none or is not for these keys, if there is no header or there are too many,
    // or if OpenSSL fails.
    static std::optional<Self> Of(const SecretKey &signing, const SecretKey &agreement,
                                  const SessionId &session, std::vector<std::uint8_t> certificate,
                                  std::vector<RtpsHeader> headers);
};

inline std::optional<Self> Self::Of(const SecretKey &signing, const SecretKey &agreement,
                                    const SessionId &session, std::vector<std::uint8_t> certificate,
                                    std::vector<RtpsHeader> headers)
{
    auto signingKey = SigningKey::Of(signing);
    auto agreementKey = AgreementKey::Of(agreement);
    const auto read = ReadCertificate(certificate);
    const Hash hash = Sha256(certificate);
    if (!signingKey || !agreementKey || !read || read->Signing != signingKey->Public() ||
        read->Agreement != agreementKey->Public() || headers.empty() || headers.size() > Claim::MostHeaders ||
        hash == Hash{})
    {
        return std::nullopt;
    }
    return Self{.Signing = std::move(*signingKey),
                .Agreement = std::move(*agreementKey),
                .Own = {.Session = session, .Certificate = hash},
                .Certificate = std::move(certificate),
                .Headers = std::move(headers)};
}

}  // namespace Rabit::Envelope
