#include "envelope/Aead.h"

#include <rabit/base/Assert.h>
#include <rabit/base/LittleEndian.h>

#include <algorithm>
#include <array>

#include "envelope/Types.h"

namespace Rabit::Envelope
{

namespace
{

using NonceBytes = std::array<std::uint8_t, 12>;

NonceBytes NonceOf(std::uint64_t number)
{
    NonceBytes nonce{};
    LittleEndian::Write(number, nonce.data() + 4);
    return nonce;
}

// OpenSSL counts bytes as int. No datagram has more than 65,535.
int LengthOf(std::span<const std::uint8_t> bytes)
{
    return static_cast<int>(bytes.size());
}

}  // namespace

Aead::Aead() : _sealing(EVP_CIPHER_CTX_new()), _opening(EVP_CIPHER_CTX_new())
{
    const EVP_CIPHER *const cipher = EVP_chacha20_poly1305();
    if (_sealing && EVP_EncryptInit_ex(_sealing.get(), cipher, nullptr, nullptr, nullptr) != 1)
    {
        _sealing.reset();
    }
    if (_opening && EVP_DecryptInit_ex(_opening.get(), cipher, nullptr, nullptr, nullptr) != 1)
    {
        _opening.reset();
    }
}

bool Aead::Seal(const SecretKey &key, std::uint64_t number, std::span<const std::uint8_t> authenticated,
                std::span<const std::uint8_t> plain, std::span<std::uint8_t> out)
{
    RABIT_ASSERT(out.size() == plain.size() + TagSize);
    const NonceBytes nonce = NonceOf(number);
    EVP_CIPHER_CTX *const context = _sealing.get();
    int length = 0;
    return context != nullptr &&
           EVP_EncryptInit_ex(context, nullptr, nullptr, key.Bytes().data(), nonce.data()) == 1 &&
           EVP_EncryptUpdate(context, nullptr, &length, authenticated.data(), LengthOf(authenticated)) == 1 &&
           (plain.empty() ||
            EVP_EncryptUpdate(context, out.data(), &length, plain.data(), LengthOf(plain)) == 1) &&
           EVP_EncryptFinal_ex(context, out.data() + plain.size(), &length) == 1 &&
           EVP_CIPHER_CTX_ctrl(context, EVP_CTRL_AEAD_GET_TAG, static_cast<int>(TagSize),
                               out.data() + plain.size()) == 1;
}

bool Aead::Open(const SecretKey &key, std::uint64_t number, std::span<const std::uint8_t> authenticated,
                std::span<const std::uint8_t> sealed, std::span<std::uint8_t> out)
{
    RABIT_ASSERT(sealed.size() >= TagSize && out.size() == sealed.size() - TagSize);
    const NonceBytes nonce = NonceOf(number);
    EVP_CIPHER_CTX *const context = _opening.get();
    const auto cipher = sealed.first(sealed.size() - TagSize);
    // OpenSSL takes the expected tag as bytes that it may change.
    std::array<std::uint8_t, TagSize> tag{};
    std::copy_n(sealed.last(TagSize).begin(), TagSize, tag.begin());
    int length = 0;
    std::uint8_t none = 0;
    return context != nullptr &&
           EVP_DecryptInit_ex(context, nullptr, nullptr, key.Bytes().data(), nonce.data()) == 1 &&
           EVP_CIPHER_CTX_ctrl(context, EVP_CTRL_AEAD_SET_TAG, static_cast<int>(TagSize), tag.data()) == 1 &&
           EVP_DecryptUpdate(context, nullptr, &length, authenticated.data(), LengthOf(authenticated)) == 1 &&
           (cipher.empty() ||
            EVP_DecryptUpdate(context, out.data(), &length, cipher.data(), LengthOf(cipher)) == 1) &&
           EVP_DecryptFinal_ex(context, &none, &length) == 1;
}

}  // namespace Rabit::Envelope
