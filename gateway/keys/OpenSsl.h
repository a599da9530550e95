// Owners of OpenSSL's objects, and its errors.
#pragma once

#include <rabit/keys/KeysError.h>

#include <openssl/bio.h>
#include <openssl/evp.h>
#include <openssl/x509.h>

#include <memory>
#include <string>
#include <string_view>

namespace Rabit::Keys
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

using KeyPtr = std::unique_ptr<EVP_PKEY, FreedBy<&EVP_PKEY_free>>;
using CertificatePtr = std::unique_ptr<X509, FreedBy<&X509_free>>;
using NamePtr = std::unique_ptr<X509_NAME, FreedBy<&X509_NAME_free>>;
using BioPtr = std::unique_ptr<BIO, FreedBy<&BIO_free_all>>;

// For OpenSSL's readers, in place of the default, which asks at the terminal: no passphrase is given.
int NoPassphrase(char *buffer, int size, int isNew, void *data);

// Returns the first error of OpenSSL on this thread, and clears the others.
std::string OpenSslError();

// Throws KeysError with OpenSSL's reason if `result` is false or null.
template <typename Result>
Result Must(Result &&result, const char *what)
{
    if (!result)
    {
        throw KeysError(std::string("cannot ") + what + ": " + OpenSslError());
    }
    return std::forward<Result>(result);
}

// Returns a BIO to read from; the text must outlive it.
BioPtr BioOf(std::string_view text);
BioPtr EmptyBio();
std::string TextOf(BIO &bio);

}  // namespace Rabit::Keys
