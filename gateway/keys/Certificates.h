// X.509 certificates on elliptic curve P-256 with SHA-256, for servers of web pages. Fleets have certificates
// of their own (envelope/Certificate.h).
#pragma once

#include <ctime>
#include <string>
#include <string_view>

#include "keys/OpenSsl.h"
#include "keys/PrivateKeyPem.h"

namespace Rabit::Keys
{

struct Validity
{
    std::time_t From = 0;
    std::time_t To = 0;
};

KeyPtr MakeKey();

// Makes a certificate with a random serial number, without issuer, extensions and signature.
CertificatePtr BeginCertificate(const X509_NAME &subject, EVP_PKEY &key, const Validity &validity);
void AddExtension(X509 &certificate, const X509 &authority, int kind, const char *value);

std::string PemOf(const X509 &certificate);
// Throws KeysError, which names `file`.
CertificatePtr ReadCertificate(std::string_view pem, const std::string &file);

Validity ValidityOf(const X509 &certificate);
bool IsKeyOf(const EVP_PKEY &key, const X509 &certificate);

// `2026-11-23`, in UTC.
std::string DayText(std::time_t time);

}  // namespace Rabit::Keys
