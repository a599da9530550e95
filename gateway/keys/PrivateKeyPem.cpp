#include "keys/PrivateKeyPem.h"

#include <openssl/pem.h>
#include <openssl/pkcs12.h>

#include <algorithm>
#include <cstdint>

namespace Rabit::Keys
{

std::string PemOf(const EVP_PKEY &key, std::string_view passphrase)
{
    const BioPtr bio = EmptyBio();
    if (passphrase.empty())
    {
        Must(PEM_write_bio_PKCS8PrivateKey(bio.get(), &key, nullptr, nullptr, 0, nullptr, nullptr) == 1,
             "write a key");
        return TextOf(*bio);
    }
    // 16 MiB of memory for each guess, OpenSSL's limit being 32 MiB, and 0.2 s of a processor in 2020.
    constexpr std::uint64_t cost = 16384;
    constexpr std::uint64_t blockSize = 8;
    constexpr std::uint64_t passes = 5;
    using InfoPtr = std::unique_ptr<PKCS8_PRIV_KEY_INFO, FreedBy<&PKCS8_PRIV_KEY_INFO_free>>;
    using AlgorithmPtr = std::unique_ptr<X509_ALGOR, FreedBy<&X509_ALGOR_free>>;
    using EncryptedPtr = std::unique_ptr<X509_SIG, FreedBy<&X509_SIG_free>>;
    const InfoPtr info = Must(InfoPtr(EVP_PKEY2PKCS8(&key)), "encrypt a key");
    AlgorithmPtr algorithm = Must(
        AlgorithmPtr(PKCS5_pbe2_set_scrypt(EVP_aes_256_cbc(), nullptr, 0, nullptr, cost, blockSize, passes)),
        "encrypt a key");
    const EncryptedPtr encrypted =
        Must(EncryptedPtr(PKCS8_set0_pbe(passphrase.data(), static_cast<int>(passphrase.size()), info.get(),
                                         algorithm.get())),
             "encrypt a key");
    static_cast<void>(algorithm.release());  // `encrypted` owns it
    Must(PEM_write_bio_PKCS8(bio.get(), encrypted.get()) == 1, "write a key");
    return TextOf(*bio);
}

KeyPtr ReadKey(std::string_view pem, const std::string &file, const AskPassphrase &ask)
{
    bool isEncrypted = false;
    const auto refuse = [](char *, int, int, void *data)
    {
        *static_cast<bool *>(data) = true;
        return -1;
    };
    const BioPtr bio = BioOf(pem);
    KeyPtr key(PEM_read_bio_PrivateKey(bio.get(), nullptr, refuse, &isEncrypted));
    if (!isEncrypted)
    {
        if (!key)
        {
            throw KeysError(file + " is no private key: " + OpenSslError());
        }
        return key;
    }
    OpenSslError();
    if (!ask)
    {
        throw KeysError(file + " is encrypted, and nobody is asked for its passphrase here");
    }
    const Secret passphrase = ask(file);
    const auto give = [](char *buffer, int size, int, void *data)
    {
        const std::string_view given = static_cast<const Secret *>(data)->Text();
        if (given.size() > static_cast<std::size_t>(size))
        {
            return -1;
        }
        std::copy(given.begin(), given.end(), buffer);
        return static_cast<int>(given.size());
    };
    const BioPtr again = BioOf(pem);
    key.reset(PEM_read_bio_PrivateKey(again.get(), nullptr, give, const_cast<Secret *>(&passphrase)));
    if (!key)
    {
        OpenSslError();
        throw KeysError("the passphrase does not open " + file);
    }
    return key;
}

}  // namespace Rabit::Keys
