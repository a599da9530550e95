#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "envelope/OpenSslOwners.h"
#include "envelope/Types.h"

namespace Rabit::Envelope
{

// An Ed25519 public key (RFC 8032). Not thread-safe. Movable.
class VerifyingKey
{
public:
    // Empty if OpenSSL fails. OpenSSL does not check here that the bytes are a point of the curve: a key that
    // is none verifies nothing.
    static std::optional<VerifyingKey> Of(const PublicKey &bytes);

    // True if the key's owner signed the message.
    bool Verify(std::span<const std::uint8_t> message, std::span<const std::uint8_t> signature);

private:
    VerifyingKey(KeyOwner key, DigestContextOwner context);

    KeyOwner _key;
    DigestContextOwner _context;
};

}  // namespace Rabit::Envelope
