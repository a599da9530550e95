#include "WebCertificate.h"

#include <rabit/keys/KeysError.h>

#include <keys/Certificates.h>
#include <keys/OpenSsl.h>

#include <openssl/crypto.h>
#include <openssl/err.h>
#include <openssl/pem.h>
#include <openssl/x509v3.h>

#include <array>
#include <memory>

namespace Ground
{
namespace
{
namespace Keys = Rabit::Keys;

constexpr const char *What = "make a certificate";
constexpr std::time_t DayS = 24 * 60 * 60;
// Some browsers refuse certificates with a longer validity.
constexpr std::time_t LongestDays = 397;

// Each as `DNS:ground` or `IP:10.0.0.5`.
std::string AlternativesOf(const WebNames &names)
{
    std::string text;
    for (const std::string &name : names.Names)
        text += (text.empty() ? "DNS:" : ",DNS:") + name;
    for (const std::string &address : names.Addresses)
        text += (text.empty() ? "IP:" : ",IP:") + address;
    return text;
}
}  // namespace

std::string MakeWebKey()
{
    return Keys::PemOf(*Keys::MakeKey());
}

std::string MakeWebCertificate(const std::string &key, const WebNames &names, std::time_t now)
{
    const Keys::KeyPtr pair = Keys::ReadKey(key, "the key of the web page");
    const Keys::NamePtr name = Keys::Must(Keys::NamePtr(X509_NAME_new()), What);
    const auto *const common = reinterpret_cast<const unsigned char *>("Rabit ground station");
    Keys::Must(X509_NAME_add_entry_by_txt(name.get(), "CN", V_ASN1_UTF8STRING, common, -1, -1, 0) == 1, What);
    const Keys::CertificatePtr certificate =
        Keys::BeginCertificate(*name, *pair, {now - DayS, now + (LongestDays - 1) * DayS});
    X509 &made = *certificate;
    Keys::Must(X509_set_issuer_name(&made, name.get()) == 1, What);
    Keys::AddExtension(made, made, NID_basic_constraints, "critical,CA:FALSE");
    Keys::AddExtension(made, made, NID_key_usage, "critical,digitalSignature");
    Keys::AddExtension(made, made, NID_ext_key_usage, "serverAuth");
    if (const std::string alternatives = AlternativesOf(names); !alternatives.empty())
        Keys::AddExtension(made, made, NID_subject_alt_name, alternatives.c_str());
    Keys::Must(X509_sign(&made, pair.get(), EVP_sha256()) > 0, What);
    return Keys::PemOf(made);
}

std::string WhyNotServe(const std::string &certificate, const std::string &key, const std::string &file,
                        std::time_t now)
{
    const Keys::CertificatePtr read = Keys::ReadCertificate(certificate, file);
    const Keys::KeyPtr pair = Keys::ReadKey(key, "its private key");
    const Keys::Validity validity = Keys::ValidityOf(*read);
    if (!Keys::IsKeyOf(*pair, *read))
        return file + " is for another key than the one beside it";
    if (now > validity.To)
        return file + " ended on " + Keys::DayText(validity.To) +
               ", and browsers refuse it; remove it, and a new one is made";
    if (now < validity.From)
        return "the clock says " + Keys::DayText(now) + ", and " + file + " is valid from " +
               Keys::DayText(validity.From) + " on; set the clock";
    return {};
}

std::string FingerprintOf(const std::string &certificate)
{
    const Keys::CertificatePtr read = Keys::ReadCertificate(certificate, "the certificate");
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned size = 0;
    Keys::Must(X509_digest(read.get(), EVP_sha256(), digest.data(), &size) == 1, "hash a certificate");
    std::string text(3 * std::size_t{size}, '\0');
    std::size_t length = 0;
    Keys::Must(OPENSSL_buf2hexstr_ex(text.data(), text.size(), &length, digest.data(), size, ':') == 1,
               "write a hash");
    text.resize(length - 1);  // without the zero behind it
    return text;
}

std::vector<std::string> NamesIn(const std::string &certificate)
{
    const auto freeNames = [](GENERAL_NAMES *names) { GENERAL_NAMES_free(names); };
    std::vector<std::string> texts;
    const Keys::BioPtr text = Keys::BioOf(certificate);
    const Keys::CertificatePtr read(PEM_read_bio_X509(text.get(), nullptr, nullptr, nullptr));
    if (!read)
    {
        ERR_clear_error();
        return texts;
    }
    const std::unique_ptr<GENERAL_NAMES, decltype(freeNames)> names(
        static_cast<GENERAL_NAMES *>(X509_get_ext_d2i(read.get(), NID_subject_alt_name, nullptr, nullptr)),
        freeNames);
    for (int i = 0; names && i < sk_GENERAL_NAME_num(names.get()); ++i)
    {
        const GENERAL_NAME *const name = sk_GENERAL_NAME_value(names.get(), i);
        if (name->type != GEN_DNS)
            continue;
        const auto *const letters = reinterpret_cast<const char *>(ASN1_STRING_get0_data(name->d.dNSName));
        std::string one(letters, static_cast<std::size_t>(ASN1_STRING_length(name->d.dNSName)));
        if (one.find('*') == std::string::npos)
            texts.push_back(std::move(one));
    }
    return texts;
}

}  // namespace Ground
