#include "keys/SignedDocument.h"

namespace Rabit::Keys
{

std::string SignDocument(std::string_view text, X509 &authority, EVP_PKEY &key)
{
    constexpr int flags = PKCS7_DETACHED | PKCS7_TEXT;
    const BioPtr in = BioOf(text);
    const Pkcs7Ptr signature =
        Must(Pkcs7Ptr(PKCS7_sign(&authority, &key, nullptr, in.get(), flags)), "sign a document");
    const BioPtr again = BioOf(text);
    const BioPtr out = EmptyBio();
    Must(SMIME_write_PKCS7(out.get(), signature.get(), again.get(), flags) == 1, "sign a document");
    return TextOf(*out);
}

std::string VerifiedDocument(std::string_view document, const X509 &authority, const std::string &file)
{
    const BioPtr in = BioOf(document);
    BIO *content = nullptr;
    const Pkcs7Ptr signature(SMIME_read_PKCS7(in.get(), &content));
    const BioPtr contentOwner(content);
    if (!signature || content == nullptr)
    {
        throw KeysError(file + " is no signed document: " + OpenSslError());
    }
    const StorePtr store = Must(StorePtr(X509_STORE_new()), "check a signature");
    Must(X509_STORE_add_cert(store.get(), const_cast<X509 *>(&authority)) == 1, "check a signature");
    X509_VERIFY_PARAM_set_flags(X509_STORE_get0_param(store.get()), X509_V_FLAG_NO_CHECK_TIME);
    const BioPtr out = EmptyBio();
    if (PKCS7_verify(signature.get(), nullptr, store.get(), content, out.get(), PKCS7_TEXT) != 1)
    {
        throw KeysError(file +
                        " is not signed by the permissions authority, or was changed: " + OpenSslError());
    }
    // The signature covers the form with carriage returns.
    std::string text = TextOf(*out);
    std::erase(text, '\r');
    return text;
}

}  // namespace Rabit::Keys
