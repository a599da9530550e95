#pragma once

#include <cstdint>
#include <span>

#include "envelope/OpenSslOwners.h"
#include "envelope/SecretKey.h"

namespace Rabit::Envelope
{

// ChaCha20-Poly1305 (RFC 8439). The nonce is four zero bytes and a number of 64 bits, little-endian: no
// number may be used twice with one key. Makes OpenSSL's contexts once, so that a datagram allocates nothing.
// Not thread-safe.
class Aead
{
public:
    Aead();

    // Writes the ciphertext and its tag: `out` must have 16 bytes (TagSize) more than `plain`. Returns false
    // if OpenSSL fails.
    bool Seal(const SecretKey &key, std::uint64_t number, std::span<const std::uint8_t> authenticated,
              std::span<const std::uint8_t> plain, std::span<std::uint8_t> out);
    // Writes the plaintext: `out` must have 16 bytes less than `sealed`, which must have at least 16. Returns
    // false if the tag does not fit or OpenSSL fails: then `out` holds no meaning.
    bool Open(const SecretKey &key, std::uint64_t number, std::span<const std::uint8_t> authenticated,
              std::span<const std::uint8_t> sealed, std::span<std::uint8_t> out);

private:
    CipherContextOwner _sealing;
    CipherContextOwner _opening;
};

}  // namespace Rabit::Envelope
