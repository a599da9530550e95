#pragma once

#include <optional>

#include "envelope/OpenSslOwners.h"
#include "envelope/SecretKey.h"
#include "envelope/Types.h"

namespace Rabit::Envelope
{

// An X25519 private key (RFC 7748). Movable.
class AgreementKey
{
public:
    // Empty if OpenSSL fails.
    static std::optional<AgreementKey> Of(const SecretKey &bytes);

    // Returns the secret that both owners compute. Empty if `other` is a point of low order, with which all
    // owners would share one secret (RFC 7748, 6.1), or if OpenSSL fails. Takes some 40 us.
    std::optional<SecretKey> SharedWith(const PublicKey &other) const;
    const PublicKey &Public() const { return _public; }

private:
    AgreementKey(KeyOwner key, const PublicKey &shown);

    KeyOwner _key;
    PublicKey _public;
};

}  // namespace Rabit::Envelope
