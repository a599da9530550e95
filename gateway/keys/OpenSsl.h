// Owners of OpenSSL's objects, and its errors.
#pragma once

#include <openssl/bio.h>
#include <openssl/evp.h>
#include <openssl/pkcs7.h>
#include <openssl/x509.h>

#include <memory>
#include <string>
#include <string_view>

#include "keys/KeysError.h"

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
using RevocationsPtr = std::unique_ptr<X509_CRL, FreedBy<&X509_CRL_free>>;
using StorePtr = std::unique_ptr<X509_STORE, FreedBy<&X509_STORE_free>>;
using Pkcs7Ptr = std::unique_ptr<PKCS7, FreedBy<&PKCS7_free>>;
using BioPtr = std::unique_ptr<BIO, FreedBy<&BIO_free_all>>;
using IntegerPtr = std::unique_ptr<ASN1_INTEGER, FreedBy<&ASN1_INTEGER_free>>;
using TimePtr = std::unique_ptr<ASN1_TIME, FreedBy<&ASN1_TIME_free>>;

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
// The text of an entry of a name; empty if there is none.
std::string TextOf(const X509_NAME_ENTRY *entry);

}  // namespace Rabit::Keys
