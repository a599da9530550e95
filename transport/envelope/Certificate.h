// The certificate of a node, at most 250 bytes. Numbers are little-endian:
//
//   offset  size  what
//   0       1     format, 1
//   1       1     role: CertificateRole
//   2       4     serial
//   6       4     begins, seconds since 1970 (UTC)
//   10      4     ends, likewise
//   14      32    Ed25519 public key
//   46      32    X25519 public key: OpenSSL does not convert one into the other
//   78      32    SHA-256 of the list of permissions (Permissions.h)
//   110     1     length of the name, 1 to 64
//   111     n     the name
//   ...     64    Ed25519 signature of the authority over "Rabit certificate 1" and all before
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "envelope/SigningKey.h"
#include "envelope/Types.h"
#include "envelope/VerifyingKey.h"

namespace Rabit::Envelope
{

constexpr std::size_t LargestCertificate = 250;
constexpr std::size_t LongestCertificateName = 64;

enum class CertificateRole : std::uint8_t
{
    Node = 0,
    Tool = 1  // writes no topic but the gateways' own, whatever its permissions say
};

struct Certificate
{
    // ASCII letters, digits, `.`, `_`, `-`.
    std::string Name;
    CertificateRole Role = CertificateRole::Node;
    Serial Number = 0;
    // Dates are for warnings. No receiver's clock ends trust; epochs and lists of revoked serials do.
    std::uint32_t Begins = 0;
    std::uint32_t Ends = 0;
    PublicKey Signing{};
    PublicKey Agreement{};
    Hash Permissions{};
    bool operator==(const Certificate &) const = default;
};

// Returns the bytes of a certificate, signed by the authority. Empty if the name has another length or other
// characters, or if OpenSSL fails.
std::vector<std::uint8_t> WriteCertificate(const Certificate &certificate, SigningKey &authority);
// Reads a certificate. Accepts any bytes; empty if they are none. Does not verify the signature.
std::optional<Certificate> ReadCertificate(std::span<const std::uint8_t> bytes);
// True if the authority signed these bytes, which must be a certificate.
bool IsCertifiedBy(std::span<const std::uint8_t> bytes, VerifyingKey &authority);

}  // namespace Rabit::Envelope
