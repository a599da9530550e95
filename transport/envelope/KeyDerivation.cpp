#include "envelope/KeyDerivation.h"

#include <openssl/core_names.h>
#include <openssl/params.h>
#include <rabit/base/LittleEndian.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "envelope/OpenSslOwners.h"

namespace Rabit::Envelope
{

namespace
{

// Appends fields of fixed sizes, so that no two lists of fields give the same bytes.
template <std::size_t Most>
class Fields
{
public:
    explicit Fields(std::string_view purpose)
    {
        _size = static_cast<std::size_t>(std::copy(purpose.begin(), purpose.end(), _bytes.begin()) -
                                         _bytes.begin());
    }

    template <std::size_t Size>
    Fields &Add(const std::array<std::uint8_t, Size> &field)
    {
        std::copy(field.begin(), field.end(), _bytes.begin() + static_cast<std::ptrdiff_t>(_size));
        _size += Size;
        return *this;
    }
    Fields &Add(Epoch epoch)
    {
        std::array<std::uint8_t, sizeof epoch> field{};
        LittleEndian::Write(epoch, field.data());
        return Add(field);
    }
    std::span<const std::uint8_t> Bytes() const { return std::span(_bytes).first(_size); }

private:
    std::array<std::uint8_t, Most> _bytes{};
    std::size_t _size = 0;
};

}  // namespace

Hash Sha256(std::span<const std::uint8_t> bytes)
{
    Hash hash{};
    unsigned size = 0;
    if (EVP_Digest(bytes.data(), bytes.size(), hash.data(), &size, EVP_sha256(), nullptr) != 1)
    {
        return Hash{};
    }
    return hash;
}

std::optional<SecretKey> Hkdf(std::span<const std::uint8_t> salt, std::span<const std::uint8_t> secret,
                              std::span<const std::uint8_t> info)
{
    // Found once, and never freed: looking it up takes longer than deriving, and strangers' claims derive.
    static EVP_KDF *const kdf = EVP_KDF_fetch(nullptr, "HKDF", nullptr);
    const KdfContextOwner context(kdf != nullptr ? EVP_KDF_CTX_new(kdf) : nullptr);
    if (!context)
    {
        return std::nullopt;
    }
    // OpenSSL reads these, but its structure of parameters has no const.
    const auto octets = [](const char *name, std::span<const std::uint8_t> bytes) {
        return OSSL_PARAM_construct_octet_string(name, const_cast<std::uint8_t *>(bytes.data()),
                                                 bytes.size());
    };
    char digest[] = "SHA256";
    const std::array<OSSL_PARAM, 5> parameters = {
        OSSL_PARAM_construct_utf8_string(OSSL_KDF_PARAM_DIGEST, digest, 0), octets(OSSL_KDF_PARAM_SALT, salt),
        octets(OSSL_KDF_PARAM_KEY, secret), octets(OSSL_KDF_PARAM_INFO, info), OSSL_PARAM_construct_end()};
    SecretKey key;
    const bool good =
        EVP_KDF_derive(context.get(), key.Room().data(), key.Room().size(), parameters.data()) == 1;
    return good ? std::optional(key) : std::nullopt;
}

std::optional<SecretKey> GroupKey(const SecretKey &epochSecret, Epoch epoch, const End &sender)
{
    Fields<64> info("Rabit group 1");
    info.Add(epoch).Add(sender.Certificate);
    return Hkdf(sender.Session, epochSecret.Bytes(), info.Bytes());
}

std::optional<SecretKey> PairwiseKey(const SecretKey &epochSecret, Epoch epoch, const SecretKey &shared,
                                     const End &sender, const End &receiver)
{
    Fields<128> info("Rabit pairwise 1");
    info.Add(epoch)
        .Add(sender.Session)
        .Add(receiver.Session)
        .Add(sender.Certificate)
        .Add(receiver.Certificate);
    return Hkdf(epochSecret.Bytes(), shared.Bytes(), info.Bytes());
}

SessionTag TagOf(const End &end)
{
    Fields<64> content("Rabit session 1");
    content.Add(end.Session).Add(end.Certificate);
    const Hash hash = Sha256(content.Bytes());
    return LittleEndian::Read<SessionTag>(std::span(hash).first(sizeof(SessionTag)));
}

}  // namespace Rabit::Envelope
