#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "envelope/OpenSslOwners.h"
#include "envelope/SecretKey.h"
#include "envelope/Types.h"

namespace Rabit::Envelope
{

// An Ed25519 private key (RFC 8032). Not thread-safe. Movable.
class SigningKey
{
public:
    // `seed`: the 32 bytes of RFC 8032, 5.1.5. Empty if OpenSSL fails.
    static std::optional<SigningKey> Of(const SecretKey &seed);

    // Signs the message. Empty if OpenSSL fails.
    std::optional<Signature> Sign(std::span<const std::uint8_t> message);
    const PublicKey &Public() const { return _public; }

private:
    SigningKey(KeyOwner key, DigestContextOwner context, const PublicKey &shown);

    KeyOwner _key;
    DigestContextOwner _context;
    PublicKey _public;
};

}  // namespace Rabit::Envelope
