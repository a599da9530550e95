// Keys and certificates, as X.509 has them: elliptic curve P-256, SHA-256.
#pragma once

#include <ctime>
#include <string>
#include <string_view>
#include <vector>

#include "keys/OpenSsl.h"
#include "keys/PrivateKeyPem.h"
#include "keys/SubjectName.h"

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
// Makes a self-signed authority. Its subject is `CN=<name>,O=<fleet>`.
CertificatePtr MakeAuthority(const std::string &fleet, const std::string &name, EVP_PKEY &key,
                             const Validity &validity);
CertificatePtr MakeCertificate(const SubjectName &subject, EVP_PKEY &key, const Validity &validity,
                               const X509 &authority, EVP_PKEY &authorityKey);
// Makes a list of revoked certificates: those given, of that authority, revoked at `now`, and those on the
// list `before`, which may be null. The list is valid as long as the authority.
RevocationsPtr MakeRevocations(const X509_CRL *before, const std::vector<const X509 *> &revoked,
                               const X509 &authority, EVP_PKEY &authorityKey, std::time_t now);

std::string PemOf(const X509 &certificate);
std::string PemOf(const X509_CRL &revocations);

// Throw KeysError, which names `file`.
CertificatePtr ReadCertificate(std::string_view pem, const std::string &file);
// Reads the file.
CertificatePtr CertificateIn(const std::string &file);
RevocationsPtr ReadRevocations(std::string_view pem, const std::string &file);

Validity ValidityOf(const X509 &certificate);
Validity ValidityOf(const X509_CRL &revocations);
bool IsSignedBy(const X509 &certificate, const X509 &authority);
bool IsSignedBy(const X509_CRL &revocations, const X509 &authority);
bool IsRevoked(const X509_CRL &revocations, const X509 &certificate);
bool IsKeyOf(const EVP_PKEY &key, const X509 &certificate);
bool AreSame(const X509 &one, const X509 &other);
// The fleet that an authority was made for.
std::string FleetOf(const X509 &authority);

// `2026-11-23`, in UTC.
std::string DayText(std::time_t time);
// `2026-11-23 12:05 UTC`
std::string MinuteText(std::time_t time);

}  // namespace Rabit::Keys
