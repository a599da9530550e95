#include "envelope/AgreementKey.h"

#include <openssl/err.h>

#include <utility>

namespace Rabit::Envelope
{

std::optional<AgreementKey> AgreementKey::Of(const SecretKey &bytes)
{
    KeyOwner key(
        EVP_PKEY_new_raw_private_key(EVP_PKEY_X25519, nullptr, bytes.Bytes().data(), bytes.Bytes().size()));
    PublicKey shown{};
    std::size_t size = shown.size();
    if (!key || EVP_PKEY_get_raw_public_key(key.get(), shown.data(), &size) != 1)
    {
        return std::nullopt;
    }
    return AgreementKey(std::move(key), shown);
}

AgreementKey::AgreementKey(KeyOwner key, const PublicKey &shown) : _key(std::move(key)), _public(shown) {}

std::optional<SecretKey> AgreementKey::SharedWith(const PublicKey &other) const
{
    const KeyOwner peer(EVP_PKEY_new_raw_public_key(EVP_PKEY_X25519, nullptr, other.data(), other.size()));
    const KeyContextOwner context(EVP_PKEY_CTX_new(_key.get(), nullptr));
    SecretKey shared;
    std::size_t size = shared.Room().size();
    const bool good = peer && context && EVP_PKEY_derive_init(context.get()) == 1 &&
                      EVP_PKEY_derive_set_peer(context.get(), peer.get()) == 1 &&
                      EVP_PKEY_derive(context.get(), shared.Room().data(), &size) == 1 &&
                      size == shared.Room().size();
    if (!good)
    {
        ERR_clear_error();
    }
    // OpenSSL refuses the shared secret of zeros. The rule does not rest on that.
    constexpr SecretKey::Content Zeros{};
    return good && CRYPTO_memcmp(shared.Bytes().data(), Zeros.data(), Zeros.size()) != 0
               ? std::optional(shared)
               : std::nullopt;
}

}  // namespace Rabit::Envelope
