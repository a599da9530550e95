#include "envelope/VerifyingKey.h"

#include <openssl/err.h>

#include <utility>

namespace Rabit::Envelope
{

std::optional<VerifyingKey> VerifyingKey::Of(const PublicKey &bytes)
{
    KeyOwner key(EVP_PKEY_new_raw_public_key(EVP_PKEY_ED25519, nullptr, bytes.data(), bytes.size()));
    DigestContextOwner context(EVP_MD_CTX_new());
    if (!key || !context || EVP_DigestVerifyInit(context.get(), nullptr, nullptr, nullptr, key.get()) != 1)
    {
        return std::nullopt;
    }
    return VerifyingKey(std::move(key), std::move(context));
}

VerifyingKey::VerifyingKey(KeyOwner key, DigestContextOwner context)
    : _key(std::move(key)), _context(std::move(context))
{
}

bool VerifyingKey::Verify(std::span<const std::uint8_t> message, std::span<const std::uint8_t> signature)
{
    // Begins again with the same key, which allocates nothing.
    const bool good = signature.size() == sizeof(Signature) &&
                      EVP_DigestVerifyInit(_context.get(), nullptr, nullptr, nullptr, nullptr) == 1 &&
                      EVP_DigestVerify(_context.get(), signature.data(), signature.size(), message.data(),
                                       message.size()) == 1;
    if (!good)
    {
        ERR_clear_error();  // a refused signature leaves an entry in the thread's queue of errors
    }
    return good;
}

}  // namespace Rabit::Envelope
