#include "keys/MemberSecrets.h"

#include <boost/algorithm/hex.hpp>

#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/rand.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <optional>
#include <utility>

#include "envelope/KeyDerivation.h"
#include "keys/OpenSsl.h"

namespace Rabit::Keys
{
namespace
{

constexpr const char *SigningKind = "ED25519";
constexpr const char *AgreementKind = "X25519";
constexpr std::string_view PemBeginning = "-----BEGIN";

template <typename Thing>
Thing FoundKey(std::optional<Thing> thing)
{
    if (!thing)
    {
        throw KeysError("OpenSSL takes no key: " + OpenSslError());
    }
    return std::move(*thing);
}

std::string PrivatePemOf(int kind, const Envelope::SecretKey &bytes, std::string_view passphrase)
{
    const KeyPtr key =
        Must(KeyPtr(EVP_PKEY_new_raw_private_key(kind, nullptr, bytes.Bytes().data(), bytes.Bytes().size())),
             "make a key");
    return PemOf(*key, passphrase);
}

[[noreturn]] void ThrowOtherKind(const std::string &file, const char *kind)
{
    OpenSslError();
    throw KeysError(file + " has a key of another kind; expected " + kind);
}

Envelope::SecretKey ReadPrivate(const char *kind, std::string_view pem, const std::string &file,
                                const AskPassphrase &ask)
{
    const KeyPtr key = ReadKey(pem, file, ask);
    Envelope::SecretKey bytes;
    std::size_t size = bytes.Room().size();
    if (EVP_PKEY_is_a(key.get(), kind) != 1 ||
        EVP_PKEY_get_raw_private_key(key.get(), bytes.Room().data(), &size) != 1 ||
        size != bytes.Room().size())
    {
        ThrowOtherKind(file, kind);
    }
    return bytes;
}

}  // namespace

Envelope::SecretKey RandomSecret()
{
    Envelope::SecretKey key;
    Must(RAND_priv_bytes(key.Room().data(), static_cast<int>(key.Room().size())) == 1, "make a key");
    return key;
}

Envelope::SigningKey SigningKeyOf(const Envelope::SecretKey &seed)
{
    return FoundKey(Envelope::SigningKey::Of(seed));
}

Envelope::AgreementKey AgreementKeyOf(const Envelope::SecretKey &bytes)
{
    return FoundKey(Envelope::AgreementKey::Of(bytes));
}

Envelope::VerifyingKey VerifyingKeyOf(const Envelope::PublicKey &key)
{
    return FoundKey(Envelope::VerifyingKey::Of(key));
}

std::string SigningKeyPem(const Envelope::SecretKey &seed, std::string_view passphrase)
{
    return PrivatePemOf(EVP_PKEY_ED25519, seed, passphrase);
}

Envelope::SecretKey ReadSigningKey(std::string_view pem, const std::string &file, const AskPassphrase &ask)
{
    return ReadPrivate(SigningKind, pem, file, ask);
}

std::string PublicKeyPem(const Envelope::PublicKey &key)
{
    const KeyPtr shown =
        Must(KeyPtr(EVP_PKEY_new_raw_public_key(EVP_PKEY_ED25519, nullptr, key.data(), key.size())),
             "write a key");
    const BioPtr bio = EmptyBio();
    Must(PEM_write_bio_PUBKEY(bio.get(), shown.get()) == 1, "write a key");
    return TextOf(*bio);
}

Envelope::PublicKey ReadPublicKey(std::string_view pem, const std::string &file)
{
    const BioPtr bio = BioOf(pem);
    const KeyPtr key(PEM_read_bio_PUBKEY(bio.get(), nullptr, &NoPassphrase, nullptr));
    if (!key)
    {
        throw KeysError(file + " is no public key: " + OpenSslError());
    }
    Envelope::PublicKey bytes{};
    std::size_t size = bytes.size();
    if (EVP_PKEY_is_a(key.get(), SigningKind) != 1 ||
        EVP_PKEY_get_raw_public_key(key.get(), bytes.data(), &size) != 1 || size != bytes.size())
    {
        ThrowOtherKind(file, SigningKind);
    }
    return bytes;
}

MemberSecrets MemberSecrets::Random()
{
    return {.Signing = RandomSecret(), .Agreement = RandomSecret()};
}

MemberSecrets MemberSecrets::Read(std::string_view pem, const std::string &file)
{
    const std::size_t first = pem.find(PemBeginning);
    const std::size_t second =
        first == std::string_view::npos ? first : pem.find(PemBeginning, first + PemBeginning.size());
    if (second == std::string_view::npos)
    {
        throw KeysError(file + " has not the two private keys of a node; copy it again, or make new ones");
    }
    return {.Signing = ReadPrivate(SigningKind, pem.substr(0, second), file, {}),
            .Agreement = ReadPrivate(AgreementKind, pem.substr(second), file, {})};
}

std::string MemberSecrets::Pem() const
{
    return SigningKeyPem(Signing) + PrivatePemOf(EVP_PKEY_X25519, Agreement, {});
}

MemberPublic MemberPublic::Of(const MemberSecrets &secrets)
{
    return {.Signing = SigningKeyOf(secrets.Signing).Public(),
            .Agreement = AgreementKeyOf(secrets.Agreement).Public()};
}

std::string MemberPublic::Fingerprint() const
{
    std::array<std::uint8_t, 2 * sizeof(Envelope::PublicKey)> both{};
    std::copy(Signing.begin(), Signing.end(), both.begin());
    std::copy(Agreement.begin(), Agreement.end(), both.begin() + sizeof(Envelope::PublicKey));
    std::string text;
    boost::algorithm::hex_lower(Envelope::Sha256(both), std::back_inserter(text));
    return text;
}

}  // namespace Rabit::Keys
