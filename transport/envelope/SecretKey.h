#pragma once

#include <openssl/crypto.h>

#include <array>
#include <cstdint>

namespace Rabit::Envelope
{

// 32 secret bytes: a key, or what keys are derived from. Each copy is overwritten when it ends.
class SecretKey
{
public:
    using Content = std::array<std::uint8_t, 32>;

    SecretKey() = default;
    explicit SecretKey(const Content &bytes) : _bytes(bytes) {}
    SecretKey(const SecretKey &) = default;
    SecretKey &operator=(const SecretKey &) = default;
    ~SecretKey() { OPENSSL_cleanse(_bytes.data(), _bytes.size()); }

    const Content &Bytes() const { return _bytes; }
    // For functions that fill it in place.
    Content &Room() { return _bytes; }

private:
    Content _bytes{};
};

}  // namespace Rabit::Envelope
