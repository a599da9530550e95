#include "keys/SigningRequest.h"

#include <gmock/gmock.h>
#include <openssl/core_names.h>
#include <openssl/ec.h>
#include <openssl/pem.h>
#include <openssl/rsa.h>
#include <openssl/x509v3.h>
#include <sys/stat.h>

#include "KeysFolder.h"

namespace Rabit::Keys
{
namespace
{

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

using RequestPtr = std::unique_ptr<X509_REQ, FreedBy<&X509_REQ_free>>;

class SigningRequestTest : public KeysFolder
{
protected:
    // Makes a request on a node whose folder is `<folder>`, and reads it.
    SigningRequest RequestOf(const std::string &node, const std::string &folder) const
    {
        const RequestedKeys made = RequestKeys(Root + "/" + folder, node);
        return ReadSigningRequest(ReadFile(made.File), made.File);
    }
    SigningRequest RequestOf(const std::string &node) const { return RequestOf(node, "on_" + node); }

    void Sign(const SigningRequest &signing, const std::string &transport = "fastdds") const
    {
        FleetKeys(Place()).Add(RequestFor(signing.Node, transport), {TestNow, 365}, &signing);
    }
    // Copies the files that the authorities made to the folder of the request.
    std::string Installed(const std::string &node) const
    {
        for (const auto &entry : fs::directory_iterator(FolderOf(node)))
        {
            fs::copy_file(entry.path(), Root + "/on_" + node + "/" + entry.path().filename().string(),
                          fs::copy_options::overwrite_existing);
        }
        return Root + "/on_" + node;
    }
};

// Returns a request of `node` for `key` as a person could make it by hand, before its signature.
RequestPtr Unsigned(const std::string &node, EVP_PKEY &key)
{
    RequestPtr request(X509_REQ_new());
    const auto *name = reinterpret_cast<const unsigned char *>(node.data());
    X509_NAME_add_entry_by_NID(X509_REQ_get_subject_name(request.get()), NID_commonName, V_ASN1_UTF8STRING,
                               name, static_cast<int>(node.size()), -1, 0);
    X509_REQ_set_pubkey(request.get(), &key);
    return request;
}

std::string Signed(X509_REQ &request, EVP_PKEY &key, const EVP_MD *hash = EVP_sha256())
{
    X509_REQ_sign(&request, &key, hash);
    const BioPtr bio = EmptyBio();
    PEM_write_bio_X509_REQ(bio.get(), &request);
    return TextOf(*bio);
}

std::string WhyUnread(const std::string &pem)
{
    try
    {
        ReadSigningRequest(pem, "r.pem");
        return "";
    }
    catch (const KeysError &error)
    {
        return error.what();
    }
}

TEST_F(SigningRequestTest, ThePrivateKeyStaysInTheFolderOfTheRequestForItsOwnerAlone)
{
    Sign(RequestOf("uav1"));
    EXPECT_FALSE(fs::exists(NodeFiles(FolderOf("uav1")).PrivateKey));
    EXPECT_EQ(fs::status(NodeFiles(Root + "/on_uav1").PrivateKey).permissions(),
              fs::perms::owner_read | fs::perms::owner_write);
    EXPECT_EQ(fs::status(Root + "/on_uav1").permissions(), fs::perms::owner_all);
}

TEST_F(SigningRequestTest, TheSignedFilesBesideThePrivateKeyAreKeysOfTheNode)
{
    Sign(RequestOf("uav1", "on_uav1"), "cyclonedds");
    EXPECT_EQ(NodeKeys(Installed("uav1")).WhyNot("uav1", "cyclonedds", 7, TestNow), "");
}

TEST_F(SigningRequestTest, AskedAgainANodeKeepsItsKey)
{
    const SigningRequest first = RequestOf("uav1");
    EXPECT_EQ(FingerprintOf(*RequestOf("uav1").PublicKey), FingerprintOf(*first.PublicKey));
}

TEST_F(SigningRequestTest, AKeyThatOthersMayReadIsNotAskedFor)
{
    RequestOf("uav1");
    fs::permissions(NodeFiles(Root + "/on_uav1").PrivateKey, fs::perms(0640));
    EXPECT_THAT(WhyNot([&] { RequestOf("uav1"); }), HasSubstr("(mode 640)"));
}

TEST_F(SigningRequestTest, NoRequestIsMadeInTheFolderOfTheFleet)
{
    EXPECT_THAT(WhyNot([&] { RequestKeys(Place(), "uav1"); }), HasSubstr("authorities"));
    EXPECT_FALSE(fs::exists(Place() + "/private_key.pem"));
}

TEST_F(SigningRequestTest, BeforeItIsSignedANodeSaysSo)
{
    RequestOf("uav1");
    EXPECT_THAT(WhyNoKeys(Root + "/on_uav1"), HasSubstr("certificate.pem; copy the files"));
}

TEST_F(SigningRequestTest, WithoutThePrivateKeyTheFolderIsNoKeysOfANode)
{
    Sign(RequestOf("uav1"));
    EXPECT_THAT(WhyNoKeys(FolderOf("uav1")), HasSubstr("there is no"));
}

TEST_F(SigningRequestTest, WhereTheAuthoritiesLieThePublicFilesCanBeChecked)
{
    Sign(RequestOf("uav1"));
    const NodeKeys keys(FolderOf("uav1"), PrivateKeyPlace::HereOrOnNode);
    EXPECT_FALSE(keys.HasPrivateKey());
    EXPECT_EQ(keys.WhyNot("uav1", "fastdds", 7, TestNow), "");
}

TEST_F(SigningRequestTest, RenewingKeepsTheKeyOfTheNode)
{
    Sign(RequestOf("uav1"));
    const FleetKeys fleet(Place());
    fleet.Renew(fleet.RequestOf("uav1"), {.Now = TestNow + 100 * TestDay, .Days = 365});
    EXPECT_FALSE(fs::exists(NodeFiles(FolderOf("uav1")).PrivateKey));
    EXPECT_EQ(NodeKeys(Installed("uav1")).WhyNot("uav1", "fastdds", 7, TestNow + 400 * TestDay), "");
}

TEST_F(SigningRequestTest, RenewingWithARequestTakesItsKey)
{
    Sign(RequestOf("uav1", "old"));
    const SigningRequest fresh = RequestOf("uav1");
    const FleetKeys fleet(Place());
    fleet.Renew(fleet.RequestOf("uav1"), {.Now = TestNow, .Days = 365}, &fresh);
    EXPECT_EQ(NodeKeys(Installed("uav1")).WhyNot("uav1", "fastdds", 7, TestNow), "");
}

TEST_F(SigningRequestTest, ANodeWithAKeyOfTheAuthoritiesMayChangeToItsOwn)
{
    Add("uav1");
    const SigningRequest fresh = RequestOf("uav1");
    const FleetKeys fleet(Place());
    fleet.Renew(fleet.RequestOf("uav1"), {.Now = TestNow, .Days = 365}, &fresh);
    EXPECT_FALSE(fs::exists(NodeFiles(FolderOf("uav1")).PrivateKey));
}

TEST_F(SigningRequestTest, AnOlderCertificateOfTheSameKeyIsNotRevoked)
{
    Sign(RequestOf("uav1"));
    const FleetKeys fleet(Place());
    fleet.Renew(fleet.RequestOf("uav1"), {.Now = TestNow, .Days = 10});
    EXPECT_THAT(WhyNot([&] { fleet.RevokeOlder("uav1", TestNow); }), HasSubstr("uav1 keeps its key"));
}

TEST_F(SigningRequestTest, ARevocationThatProtectsNothingIsRefusedBeforeARenewal)
{
    const SigningRequest same = RequestOf("uav1");
    Sign(same);
    const FleetKeys fleet(Place());
    EXPECT_THAT(WhyNot([&] { fleet.CheckNewKey("uav1"); }), HasSubstr("renew it with `--request`"));
    EXPECT_THAT(WhyNot([&] { fleet.CheckNewKey("uav1", &same); }), HasSubstr("uav1 keeps its key"));
}

TEST_F(SigningRequestTest, TheOlderCertificateOfAnotherKeyIsRevokedAloneOnDemand)
{
    Sign(RequestOf("uav1", "old"));
    const SigningRequest fresh = RequestOf("uav1");
    const FleetKeys fleet(Place());
    fleet.CheckNewKey("uav1", &fresh);
    fleet.Renew(fleet.RequestOf("uav1"), {.Now = TestNow, .Days = 10}, &fresh);
    EXPECT_EQ(fleet.RevokeOlder("uav1", TestNow), 1U);
    EXPECT_EQ(NodeKeys(Installed("uav1")).WhyNot("uav1", "fastdds", 7, TestNow), "");
}

TEST_F(SigningRequestTest, ARevokedNodeIsOnTheListOfTheOthers)
{
    Sign(RequestOf("uav1"));
    Add("uav2");
    const CertificatePtr certificate = ReadCertificate(ReadFile(NodeFiles(FolderOf("uav1")).Certificate), "");
    EXPECT_EQ(FleetKeys(Place()).Revoke("uav1", TestNow), 1U);
    EXPECT_TRUE(IsRevoked(*ReadRevocations(ReadFile(NodeFiles(FolderOf("uav2")).Revoked), ""), *certificate));
}

TEST_F(SigningRequestTest, ARevokedKeyIsNotSignedAgain)
{
    const SigningRequest request = RequestOf("uav1");
    Sign(request);
    FleetKeys(Place()).Revoke("uav1", TestNow);
    EXPECT_THAT(WhyNot([&] { Sign(request); }), HasSubstr("revoked"));
    EXPECT_FALSE(fs::exists(FolderOf("uav1")));
}

// A list of revoked certificates on which one of a key is that the node still has.
TEST_F(SigningRequestTest, TheRevokedKeyOfThePresentCertificateIsNotRenewed)
{
    const SigningRequest request = RequestOf("uav1");
    Sign(request);
    const std::string place = Place() + "/authority/";
    const CertificatePtr authority = ReadCertificate(ReadFile(place + "identity.pem"), "");
    const CertificatePtr present = ReadCertificate(ReadFile(NodeFiles(FolderOf("uav1")).Certificate), "");
    const KeyPtr key = ReadKey(ReadSecret(place + "identity_key.pem"), "");
    WriteFile(place + "revoked.pem",
              PemOf(*MakeRevocations(nullptr, {present.get()}, *authority, *key, TestNow)));
    const FleetKeys fleet(Place());
    const FleetKeys::Request access = fleet.RequestOf("uav1");
    EXPECT_THAT(WhyNot([&] { fleet.Renew(access, {TestNow, 365}, &request); }), HasSubstr("revoked"));
    EXPECT_THAT(WhyNot([&] { fleet.Renew(access, {TestNow, 365}); }), HasSubstr("revoked"));
}

TEST_F(SigningRequestTest, TheKeyOfAnotherNodeIsNotSigned)
{
    Sign(RequestOf("uav1", "disk"));
    EXPECT_THAT(WhyNot([&] { Sign(RequestOf("uav2", "disk")); }), HasSubstr("has the key of uav1"));
}

TEST_F(SigningRequestTest, ARequestOfAnotherNodeRenewsNothing)
{
    Add("uav1");
    const SigningRequest other = RequestOf("uav2");
    const FleetKeys fleet(Place());
    EXPECT_THAT(WhyNot(
                    [&] {
                        fleet.Renew(fleet.RequestOf("uav1"), {TestNow, 365}, &other);
                    }),
                HasSubstr("is of `uav2`"));
}

TEST_F(SigningRequestTest, ARequestDoesNotReplaceTheKeysOfANode)
{
    Add("uav1");
    EXPECT_THAT(WhyNot([&] { Sign(RequestOf("uav1")); }), HasSubstr("there already"));
}

TEST_F(SigningRequestTest, ExtensionsOfARequestAreIgnored)
{
    const KeyPtr key = MakeKey();
    const RequestPtr request = Unsigned("uav1", *key);
    STACK_OF(X509_EXTENSION) *wishes = sk_X509_EXTENSION_new_null();
    sk_X509_EXTENSION_push(wishes,
                           X509V3_EXT_conf_nid(nullptr, nullptr, NID_basic_constraints, "critical,CA:TRUE"));
    X509_REQ_add_extensions(request.get(), wishes);
    sk_X509_EXTENSION_pop_free(wishes, X509_EXTENSION_free);
    Sign(ReadSigningRequest(Signed(*request, *key), "r.pem"));
    const CertificatePtr made = ReadCertificate(ReadFile(NodeFiles(FolderOf("uav1")).Certificate), "");
    EXPECT_EQ(X509_check_ca(made.get()), 0);
}

TEST_F(SigningRequestTest, ARequestIsSignedByTheKeyInIt)
{
    const KeyPtr key = MakeKey();
    const KeyPtr other = MakeKey();
    EXPECT_THAT(WhyUnread(Signed(*Unsigned("uav1", *key), *other)), HasSubstr("is not signed by the key"));
}

TEST_F(SigningRequestTest, ARequestWithAnOldHashIsRefused)
{
    const KeyPtr key = MakeKey();
    EXPECT_THAT(WhyUnread(Signed(*Unsigned("uav1", *key), *key, EVP_sha1())),
                HasSubstr("is not signed by the key"));
}

TEST_F(SigningRequestTest, NamesThatNoNodeCanHaveAreRefused)
{
    const KeyPtr key = MakeKey();
    for (const std::string name : {"..", "authority", "a/b", ".uav1", "a\nb", "uav 1"})
    {
        EXPECT_THAT(WhyUnread(Signed(*Unsigned(name, *key), *key)),
                    AllOf(HasSubstr("r.pem: "), HasSubstr("cannot be the name")))
            << name;
    }
}

TEST_F(SigningRequestTest, ANameOfSeveralPartsIsRefused)
{
    const KeyPtr key = MakeKey();
    const RequestPtr request = Unsigned("uav1", *key);
    X509_NAME_add_entry_by_NID(X509_REQ_get_subject_name(request.get()), NID_commonName, V_ASN1_UTF8STRING,
                               reinterpret_cast<const unsigned char *>("uav2"), 4, -1, 0);
    EXPECT_THAT(WhyUnread(Signed(*request, *key)), HasSubstr("cannot be the name"));
}

TEST_F(SigningRequestTest, KeysOfOtherKindsAreRefused)
{
    const KeyPtr rsa(EVP_RSA_gen(2048));
    const KeyPtr curve(EVP_EC_gen("P-384"));
    const KeyPtr edwards(EVP_PKEY_Q_keygen(nullptr, nullptr, "ED25519"));
    const KeyPtr compressed(EVP_EC_gen("P-256"));
    ASSERT_EQ(EVP_PKEY_set_utf8_string_param(compressed.get(), OSSL_PKEY_PARAM_EC_POINT_CONVERSION_FORMAT,
                                             OSSL_PKEY_EC_POINT_CONVERSION_FORMAT_COMPRESSED),
              1);
    for (EVP_PKEY *key : {rsa.get(), curve.get(), compressed.get()})
    {
        EXPECT_THAT(WhyUnread(Signed(*Unsigned("uav1", *key), *key)), HasSubstr("key of another kind"));
    }
    EXPECT_THAT(WhyUnread(Signed(*Unsigned("uav1", *edwards), *edwards, nullptr)),
                HasSubstr("key of another kind"));
}

TEST_F(SigningRequestTest, OtherTextIsRefused)
{
    EXPECT_THAT(WhyUnread(""), HasSubstr("no request of a node"));
    EXPECT_THAT(WhyUnread(ReadFile(Place() + "/authority/identity.pem")), HasSubstr("no request of a node"));
    EXPECT_THAT(WhyUnread(std::string(17 * 1024, 'x')), HasSubstr("larger than 16 KiB"));
}

// OpenSSL would ask for a passphrase at the terminal.
TEST_F(SigningRequestTest, NobodyIsAskedForThePassphraseOfFilesThatAreNotSecret)
{
    const auto closed = [](const std::string &kind)
    {
        return "-----BEGIN " + kind + "-----\nProc-Type: 4,ENCRYPTED\nDEK-Info: " +
               "AES-256-CBC,00112233445566778899AABBCCDDEEFF\n\nAAAAAAAAAAAAAAAAAAAAAA==\n-----END " + kind +
               "-----\n";
    };
    EXPECT_THAT(WhyUnread(closed("CERTIFICATE REQUEST")), HasSubstr("bad password read"));
    EXPECT_THAT(WhyNot([&] { ReadCertificate(closed("CERTIFICATE"), "c.pem"); }),
                HasSubstr("bad password read"));
    EXPECT_THAT(WhyNot([&] { ReadRevocations(closed("X509 CRL"), "l.pem"); }),
                HasSubstr("bad password read"));
}

TEST_F(SigningRequestTest, NoByteOfARequestMayBeChanged)
{
    const KeyPtr key = MakeKey();
    const RequestPtr request = Unsigned("uav1", *key);
    X509_REQ_sign(request.get(), key.get(), EVP_sha256());
    unsigned char *bytes = nullptr;
    const int size = i2d_X509_REQ(request.get(), &bytes);
    const std::vector<unsigned char> whole(bytes, bytes + size);
    OPENSSL_free(bytes);
    for (std::size_t i = 0; i < whole.size(); ++i)
    {
        std::vector<unsigned char> changed = whole;
        changed[i] ^= 1;
        const unsigned char *at = changed.data();
        const RequestPtr other(d2i_X509_REQ(nullptr, &at, static_cast<long>(changed.size())));
        if (!other)
        {
            continue;
        }
        const BioPtr bio = EmptyBio();
        PEM_write_bio_X509_REQ(bio.get(), other.get());
        EXPECT_NE(WhyUnread(TextOf(*bio)), "") << "byte " << i;
    }
}

TEST_F(SigningRequestTest, AFifoIsNoRequest)
{
    ASSERT_EQ(::mkfifo((Root + "/fifo").c_str(), 0600), 0);
    EXPECT_THAT(WhyNot([&] { ReadFile(Root + "/fifo"); }), HasSubstr("is no file"));
}

}  // namespace
}  // namespace Rabit::Keys
