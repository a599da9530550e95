// Owners of OpenSSL's objects.
#pragma once

#include <openssl/evp.h>
#include <openssl/kdf.h>

#include <memory>

namespace Rabit::Envelope
{

template <auto Free>
struct FreedBy
{
    template <typename Thing>
    void operator()(Thing *thing) const
    {
        Free(thing);
    }
};

using KeyOwner = std::unique_ptr<EVP_PKEY, FreedBy<&EVP_PKEY_free>>;
using KeyContextOwner = std::unique_ptr<EVP_PKEY_CTX, FreedBy<&EVP_PKEY_CTX_free>>;
using DigestContextOwner = std::unique_ptr<EVP_MD_CTX, FreedBy<&EVP_MD_CTX_free>>;
using CipherContextOwner = std::unique_ptr<EVP_CIPHER_CTX, FreedBy<&EVP_CIPHER_CTX_free>>;
using KdfContextOwner = std::unique_ptr<EVP_KDF_CTX, FreedBy<&EVP_KDF_CTX_free>>;

}  // namespace Rabit::Envelope
