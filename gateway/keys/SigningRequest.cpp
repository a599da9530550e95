#include "keys/SigningRequest.h"

#include <boost/algorithm/hex.hpp>

#include <openssl/pem.h>
#include <openssl/sha.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <iterator>
#include <vector>

#include "keys/Certificates.h"
#include "keys/FleetKeys.h"
#include "keys/KeyFiles.h"
#include "keys/KeysError.h"
#include "keys/NodeKeys.h"
#include "keys/SubjectName.h"

namespace Rabit::Keys
{
namespace
{

namespace fs = std::filesystem;

using RequestPtr = std::unique_ptr<X509_REQ, FreedBy<&X509_REQ_free>>;

constexpr std::size_t LargestRequest = 16 * 1024;
constexpr std::size_t PointSize = 64;  // the coordinates of a point of P-256

std::vector<unsigned char> EncodedKey(const EVP_PKEY &key)
{
    unsigned char *bytes = nullptr;
    const int size = i2d_PUBKEY(&key, &bytes);
    Must(size > 0, "encode a public key");
    std::vector<unsigned char> encoded(bytes, bytes + size);
    OPENSSL_free(bytes);
    return encoded;
}

// True if the key is encoded exactly like those of MakeKey, but for the coordinates of its point: an elliptic
// curve by its name, P-256, and the point not compressed.
bool IsLikeOurs(const EVP_PKEY &key)
{
    const std::vector<unsigned char> own = EncodedKey(*MakeKey());
    const std::vector<unsigned char> other = EncodedKey(key);
    return own.size() == other.size() &&
           std::equal(own.begin(), own.end() - static_cast<std::ptrdiff_t>(PointSize), other.begin());
}

std::string CommonNameOf(const X509_NAME &name)
{
    const X509_NAME_ENTRY *entry = X509_NAME_get_entry(&name, 0);
    const bool isIt =
        X509_NAME_entry_count(&name) == 1 && OBJ_obj2nid(X509_NAME_ENTRY_get_object(entry)) == NID_commonName;
    return TextOf(isIt ? entry : nullptr);
}

}  // namespace

std::string MakeSigningRequest(const std::string &node, EVP_PKEY &privateKey)
{
    constexpr const char *what = "make a request";
    const RequestPtr request = Must(RequestPtr(X509_REQ_new()), what);
    const auto *name = reinterpret_cast<const unsigned char *>(node.data());
    const bool done =
        X509_REQ_set_version(request.get(), 0) == 1 &&
        X509_NAME_add_entry_by_NID(X509_REQ_get_subject_name(request.get()), NID_commonName,
                                   V_ASN1_UTF8STRING, name, static_cast<int>(node.size()), -1, 0) == 1 &&
        X509_REQ_set_pubkey(request.get(), &privateKey) == 1 &&
        X509_REQ_sign(request.get(), &privateKey, EVP_sha256()) > 0;
    Must(done, what);
    const BioPtr bio = EmptyBio();
    Must(PEM_write_bio_X509_REQ(bio.get(), request.get()) == 1, what);
    return TextOf(*bio);
}

SigningRequest ReadSigningRequest(std::string_view pem, const std::string &file)
{
    if (pem.size() > LargestRequest)
    {
        throw KeysError(file + " is larger than 16 KiB: no request of a node");
    }
    const BioPtr bio = BioOf(pem);
    const RequestPtr request(PEM_read_bio_X509_REQ(bio.get(), nullptr, &NoPassphrase, nullptr));
    if (!request)
    {
        throw KeysError(file + " is no request of a node: " + OpenSslError());
    }
    KeyPtr key(X509_REQ_get_pubkey(request.get()));
    if (!key || !IsLikeOurs(*key))
    {
        OpenSslError();
        throw KeysError(file + " has a key of another kind; expected an elliptic curve key on P-256");
    }
    if (X509_REQ_get_signature_nid(request.get()) != NID_ecdsa_with_SHA256 ||
        X509_REQ_verify(request.get(), key.get()) != 1)
    {
        OpenSslError();
        throw KeysError(file + " is not signed by the key in it, or was changed; copy it again");
    }
    const std::string node = CommonNameOf(*X509_REQ_get_subject_name(request.get()));
    try
    {
        CheckNodeName(node);
    }
    catch (const KeysError &error)
    {
        throw KeysError(file + ": " + error.what());
    }
    return {node, std::move(key)};
}

std::string FingerprintOf(const EVP_PKEY &key)
{
    const std::vector<unsigned char> encoded = EncodedKey(key);
    std::array<unsigned char, SHA256_DIGEST_LENGTH> hash{};
    SHA256(encoded.data(), encoded.size(), hash.data());
    std::string text;
    boost::algorithm::hex_lower(hash, std::back_inserter(text));
    return text;
}

RequestedKeys RequestKeys(const std::string &folder, const std::string &node)
{
    CheckNodeName(node);
    if (FleetKeys::IsFleet(folder))
    {
        throw KeysError(folder + " has the authorities of a fleet; name another folder for the node's keys");
    }
    if (!fs::exists(folder))
    {
        MakeSecretFolder(folder);
    }
    const std::string place = NodeFiles(folder).PrivateKey;
    if (!fs::exists(place))
    {
        WriteNewSecret(place, PemOf(*MakeKey()));
    }
    // Another program may have made the key first.
    const KeyPtr key = ReadKey(ReadSecret(place), place);
    RequestedKeys made{folder + "/" + node + ".request.pem", FingerprintOf(*key)};
    WriteFile(made.File, MakeSigningRequest(node, *key));
    return made;
}

}  // namespace Rabit::Keys
