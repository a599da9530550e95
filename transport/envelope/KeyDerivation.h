// Keys and names that both sides of a datagram derive: HKDF (RFC 5869) and SHA-256. README.md has the bytes.
#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <span>

#include "envelope/SecretKey.h"
#include "envelope/Types.h"

namespace Rabit::Envelope
{

// One end of a datagram.
struct End
{
    SessionId Session{};
    Hash Certificate{};
    auto operator<=>(const End &) const = default;
};

// Zeros if OpenSSL fails, which no content hashes to.
Hash Sha256(std::span<const std::uint8_t> bytes);

// HKDF-SHA256 with 32 bytes of output. Empty if OpenSSL fails.
std::optional<SecretKey> Hkdf(std::span<const std::uint8_t> salt, std::span<const std::uint8_t> secret,
                              std::span<const std::uint8_t> info);

// The key of all that `sender` sends in group mode in that epoch. Each member can derive it.
std::optional<SecretKey> GroupKey(const SecretKey &epochSecret, Epoch epoch, const End &sender);
// The key from `sender` to `receiver`: only these two can derive it. `shared`: AgreementKey::SharedWith.
std::optional<SecretKey> PairwiseKey(const SecretKey &epochSecret, Epoch epoch, const SecretKey &shared,
                                     const End &sender, const End &receiver);

// The first four bytes of the hash of session and certificate: another certificate cannot use the tag of a
// session by repeating the session's id.
SessionTag TagOf(const End &end);

}  // namespace Rabit::Envelope
