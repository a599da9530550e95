#include "keys/Certificates.h"

#include <rabit/base/UtcText.h>

#include <openssl/ec.h>
#include <openssl/pem.h>
#include <openssl/x509v3.h>

#include <memory>

namespace Rabit::Keys
{
namespace
{

constexpr int SerialBits = 127;

using IntegerPtr = std::unique_ptr<ASN1_INTEGER, FreedBy<&ASN1_INTEGER_free>>;

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

std::string PemOf(const X509 &certificate)
{
    const BioPtr bio = EmptyBio();
    Must(PEM_write_bio_X509(bio.get(), &certificate) == 1, "write a certificate");
    return TextOf(*bio);
}

CertificatePtr ReadCertificate(std::string_view pem, const std::string &file)
{
    const BioPtr bio = BioOf(pem);
    CertificatePtr certificate(PEM_read_bio_X509(bio.get(), nullptr, &NoPassphrase, nullptr));
    if (!certificate)
    {
        throw KeysError(file + " is no certificate: " + OpenSslError());
    }
    return certificate;
}

Validity ValidityOf(const X509 &certificate)
{
    return {TimeOf(*X509_get0_notBefore(&certificate)), TimeOf(*X509_get0_notAfter(&certificate))};
}

bool IsKeyOf(const EVP_PKEY &key, const X509 &certificate)
{
    return EVP_PKEY_eq(&key, X509_get0_pubkey(&certificate)) == 1;
}

std::string DayText(std::time_t time)
{
    return UtcText(time, "%Y-%m-%d");
}

}  // namespace Rabit::Keys
