#include "keys/Certificates.h"

#include <rabit/base/UtcText.h>

#include <openssl/ec.h>
#include <openssl/pem.h>
#include <openssl/rand.h>
#include <openssl/x509v3.h>

#include <limits>

#include "keys/KeyFiles.h"

namespace Rabit::Keys
{
namespace
{

constexpr int SerialBits = 127;

IntegerPtr RandomSerial()
{
    using NumberPtr = std::unique_ptr<BIGNUM, FreedBy<&BN_free>>;
    const NumberPtr number = Must(NumberPtr(BN_new()), "make a serial number");
    Must(BN_rand(number.get(), SerialBits, BN_RAND_TOP_ONE, BN_RAND_BOTTOM_ANY) == 1, "make a serial number");
    return Must(IntegerPtr(BN_to_ASN1_INTEGER(number.get(), nullptr)), "make a serial number");
}

std::time_t TimeOf(const ASN1_TIME &time)
{
    std::tm parts = {};
    Must(ASN1_TIME_to_tm(&time, &parts) == 1, "read a date");
    return ::timegm(&parts);
}

template <typename Thing>
Thing Found(Thing thing, const char *what, const std::string &file)
{
    if (!thing)
    {
        throw KeysError(file + " is no " + what + ": " + OpenSslError());
    }
    return thing;
}

}  // namespace

KeyPtr MakeKey()
{
    return Must(KeyPtr(EVP_EC_gen("P-256")), "make a key");
}

void AddExtension(X509 &certificate, const X509 &authority, int kind, const char *value)
{
    X509V3_CTX context;
    X509V3_set_ctx(&context, const_cast<X509 *>(&authority), &certificate, nullptr, nullptr, 0);
    using ExtensionPtr = std::unique_ptr<X509_EXTENSION, FreedBy<&X509_EXTENSION_free>>;
    const ExtensionPtr extension =
        Must(ExtensionPtr(X509V3_EXT_conf_nid(nullptr, &context, kind, const_cast<char *>(value))),
             "make a certificate");
    Must(X509_add_ext(&certificate, extension.get(), -1) == 1, "make a certificate");
}

CertificatePtr BeginCertificate(const X509_NAME &subject, EVP_PKEY &key, const Validity &validity)
{
    constexpr long version3 = 2;
    CertificatePtr certificate = Must(CertificatePtr(X509_new()), "make a certificate");
    const IntegerPtr serial = RandomSerial();
    const bool done = X509_set_version(certificate.get(), version3) == 1 &&
                      X509_set_serialNumber(certificate.get(), serial.get()) == 1 &&
                      ASN1_TIME_set(X509_getm_notBefore(certificate.get()), validity.From) != nullptr &&
                      ASN1_TIME_set(X509_getm_notAfter(certificate.get()), validity.To) != nullptr &&
                      X509_set_subject_name(certificate.get(), &subject) == 1 &&
                      X509_set_pubkey(certificate.get(), &key) == 1;
    Must(done, "make a certificate");
    return certificate;
}

CertificatePtr MakeAuthority(const std::string &fleet, const std::string &name, EVP_PKEY &key,
                             const Validity &validity)
{
    const NamePtr subject = Must(NamePtr(X509_NAME_new()), "make a name");
    const auto add = [&](const char *field, const std::string &value)
    {
        Must(X509_NAME_add_entry_by_txt(subject.get(), field, V_ASN1_UTF8STRING,
                                        reinterpret_cast<const unsigned char *>(value.data()),
                                        static_cast<int>(value.size()), -1, 0) == 1,
             "make a name");
    };
    add("O", fleet);
    add("CN", name);
    CertificatePtr certificate = BeginCertificate(*subject, key, validity);
    Must(X509_set_issuer_name(certificate.get(), subject.get()) == 1, "make a certificate");
    AddExtension(*certificate, *certificate, NID_basic_constraints, "critical,CA:TRUE,pathlen:0");
    AddExtension(*certificate, *certificate, NID_key_usage, "critical,digitalSignature,keyCertSign,cRLSign");
    AddExtension(*certificate, *certificate, NID_subject_key_identifier, "hash");
    Must(X509_sign(certificate.get(), &key, EVP_sha256()) > 0, "sign a certificate");
    return certificate;
}

CertificatePtr MakeCertificate(const SubjectName &subject, EVP_PKEY &key, const Validity &validity,
                               const X509 &authority, EVP_PKEY &authorityKey)
{
    const NamePtr name = subject.Encoded();
    CertificatePtr certificate = BeginCertificate(*name, key, validity);
    Must(X509_set_issuer_name(certificate.get(), X509_get_subject_name(&authority)) == 1,
         "make a certificate");
    AddExtension(*certificate, authority, NID_basic_constraints, "critical,CA:FALSE");
    AddExtension(*certificate, authority, NID_key_usage, "critical,digitalSignature");
    AddExtension(*certificate, authority, NID_authority_key_identifier, "keyid:always");
    Must(X509_sign(certificate.get(), &authorityKey, EVP_sha256()) > 0, "sign a certificate");
    return certificate;
}

RevocationsPtr MakeRevocations(const X509_CRL *before, const std::vector<const X509 *> &revoked,
                               const X509 &authority, EVP_PKEY &authorityKey, std::time_t now)
{
    constexpr long version2 = 1;
    RevocationsPtr list = Must(RevocationsPtr(before != nullptr ? X509_CRL_dup(before) : X509_CRL_new()),
                               "make a list of revoked certificates");
    const TimePtr revokedAt = Must(TimePtr(ASN1_TIME_set(nullptr, now)), "make a date");
    bool done =
        X509_CRL_set_version(list.get(), version2) == 1 &&
        X509_CRL_set_issuer_name(list.get(), X509_get_subject_name(&authority)) == 1 &&
        // Valid as long as the authority: a node whose clock is outside of that time refuses everybody.
        X509_CRL_set1_lastUpdate(list.get(), X509_get0_notBefore(&authority)) == 1 &&
        X509_CRL_set1_nextUpdate(list.get(), X509_get0_notAfter(&authority)) == 1;
    for (const X509 *certificate : revoked)
    {
        if (IsRevoked(*list, *certificate))
        {
            continue;
        }
        using EntryPtr = std::unique_ptr<X509_REVOKED, FreedBy<&X509_REVOKED_free>>;
        EntryPtr entry = Must(EntryPtr(X509_REVOKED_new()), "revoke a certificate");
        done = done &&
               X509_REVOKED_set_serialNumber(
                   entry.get(), const_cast<ASN1_INTEGER *>(X509_get0_serialNumber(certificate))) == 1 &&
               X509_REVOKED_set_revocationDate(entry.get(), revokedAt.get()) == 1 &&
               X509_CRL_add0_revoked(list.get(), entry.get()) == 1;
        static_cast<void>(done ? entry.release() : nullptr);  // the list owns it
    }
    done =
        done && X509_CRL_sort(list.get()) == 1 && X509_CRL_sign(list.get(), &authorityKey, EVP_sha256()) > 0;
    Must(done, "make a list of revoked certificates");
    return list;
}

std::string PemOf(const X509 &certificate)
{
    const BioPtr bio = EmptyBio();
    Must(PEM_write_bio_X509(bio.get(), &certificate) == 1, "write a certificate");
    return TextOf(*bio);
}

std::string PemOf(const X509_CRL &revocations)
{
    const BioPtr bio = EmptyBio();
    Must(PEM_write_bio_X509_CRL(bio.get(), &revocations) == 1, "write a list of revoked certificates");
    return TextOf(*bio);
}

CertificatePtr ReadCertificate(std::string_view pem, const std::string &file)
{
    const BioPtr bio = BioOf(pem);
    return Found(CertificatePtr(PEM_read_bio_X509(bio.get(), nullptr, &NoPassphrase, nullptr)), "certificate",
                 file);
}

CertificatePtr CertificateIn(const std::string &file)
{
    return ReadCertificate(ReadFile(file), file);
}

RevocationsPtr ReadRevocations(std::string_view pem, const std::string &file)
{
    const BioPtr bio = BioOf(pem);
    return Found(RevocationsPtr(PEM_read_bio_X509_CRL(bio.get(), nullptr, &NoPassphrase, nullptr)),
                 "list of revoked certificates", file);
}

Validity ValidityOf(const X509 &certificate)
{
    return {TimeOf(*X509_get0_notBefore(&certificate)), TimeOf(*X509_get0_notAfter(&certificate))};
}

Validity ValidityOf(const X509_CRL &revocations)
{
    // The end is optional in X.509.
    const ASN1_TIME *end = X509_CRL_get0_nextUpdate(&revocations);
    return {TimeOf(*X509_CRL_get0_lastUpdate(&revocations)),
            end != nullptr ? TimeOf(*end) : std::numeric_limits<std::time_t>::max()};
}

bool IsSignedBy(const X509 &certificate, const X509 &authority)
{
    const bool isSigned =
        X509_NAME_cmp(X509_get_issuer_name(&certificate), X509_get_subject_name(&authority)) == 0 &&
        X509_verify(const_cast<X509 *>(&certificate), X509_get0_pubkey(&authority)) == 1;
    OpenSslError();
    return isSigned;
}

bool IsSignedBy(const X509_CRL &revocations, const X509 &authority)
{
    const bool isSigned =
        X509_NAME_cmp(X509_CRL_get_issuer(&revocations), X509_get_subject_name(&authority)) == 0 &&
        X509_CRL_verify(const_cast<X509_CRL *>(&revocations), X509_get0_pubkey(&authority)) == 1;
    OpenSslError();
    return isSigned;
}

bool IsRevoked(const X509_CRL &revocations, const X509 &certificate)
{
    X509_REVOKED *entry = nullptr;
    return X509_CRL_get0_by_serial(const_cast<X509_CRL *>(&revocations), &entry,
                                   const_cast<ASN1_INTEGER *>(X509_get0_serialNumber(&certificate))) != 0;
}

bool IsKeyOf(const EVP_PKEY &key, const X509 &certificate)
{
    return EVP_PKEY_eq(&key, X509_get0_pubkey(&certificate)) == 1;
}

bool AreSame(const X509 &one, const X509 &other)
{
    return X509_cmp(&one, &other) == 0;
}

std::string FleetOf(const X509 &authority)
{
    const X509_NAME *name = X509_get_subject_name(&authority);
    const int at = X509_NAME_get_index_by_NID(name, NID_organizationName, -1);
    return TextOf(at < 0 ? nullptr : X509_NAME_get_entry(name, at));
}

std::string DayText(std::time_t time)
{
    return UtcText(time, "%Y-%m-%d");
}

std::string MinuteText(std::time_t time)
{
    return UtcText(time, "%Y-%m-%d %H:%M UTC");
}

}  // namespace Rabit::Keys
