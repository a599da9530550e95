#include "envelope/SigningKey.h"

#include <utility>

namespace Rabit::Envelope
{

std::optional<SigningKey> SigningKey::Of(const SecretKey &seed)
{
    KeyOwner key(
        EVP_PKEY_new_raw_private_key(EVP_PKEY_ED25519, nullptr, seed.Bytes().data(), seed.Bytes().size()));
    DigestContextOwner context(EVP_MD_CTX_new());
    PublicKey shown{};
    std::size_t size = shown.size();
    if (!key || !context || EVP_PKEY_get_raw_public_key(key.get(), shown.data(), &size) != 1 ||
        EVP_DigestSignInit(context.get(), nullptr, nullptr, nullptr, key.get()) != 1)
    {
        return std::nullopt;
    }
    return SigningKey(std::move(key), std::move(context), shown);
}

SigningKey::SigningKey(KeyOwner key, DigestContextOwner context, const PublicKey &shown)
    : _key(std::move(key)), _context(std::move(context)), _public(shown)
{
}

std::optional<Signature> SigningKey::Sign(std::span<const std::uint8_t> message)
{
    Signature signature{};
    std::size_t size = signature.size();
    // Begins again with the same key, which allocates nothing.
    const bool good =
        EVP_DigestSignInit(_context.get(), nullptr, nullptr, nullptr, nullptr) == 1 &&
        EVP_DigestSign(_context.get(), signature.data(), &size, message.data(), message.size()) == 1 &&
        size == signature.size();
    return good ? std::optional(signature) : std::nullopt;
}

}  // namespace Rabit::Envelope
