#include <gmock/gmock.h>
#include <openssl/pem.h>

#include <algorithm>
#include <array>
#include <memory>
#include <new>

#include "FleetFolder.h"
#include "keys/Certificates.h"
#include "keys/MemberSecrets.h"
#include "keys/PrivateKeyPem.h"

namespace Rabit::Keys
{
namespace
{

using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;

// A fleet whose authority has an encrypted key, beside the plain one of FleetFolder.
class PassphraseTest : public FleetFolder
{
protected:
    PassphraseTest() { FleetAuthority::Init(Closed(), "open sesame"); }

    std::string Closed() const { return Root + "/closed"; }
    AskPassphrase Answer(const std::string &passphrase)
    {
        return [this, passphrase](const std::string &file)
        {
            _asked.push_back(file);
            return Secret(passphrase);
        };
    }
    void AddWith(AskPassphrase ask) const
    {
        FleetAuthority(Closed(), std::move(ask)).Add(RequestFor("uav1"), Year());
    }
    bool IsMade() const { return std::filesystem::exists(Closed() + "/uav1"); }

    std::vector<std::string> _asked;
};

TEST_F(PassphraseTest, OnlyTheKeyOfTheAuthorityIsEncrypted)
{
    AddWith(Answer("open sesame"));
    EXPECT_THAT(ReadSecret(Closed() + "/authority/key"), HasSubstr("BEGIN ENCRYPTED PRIVATE KEY"));
    EXPECT_EQ(MemberFolder(Closed() + "/uav1").WhyNot("uav1"), "");
}

TEST_F(PassphraseTest, TheKeyIsOpenedOnce)
{
    const FleetAuthority fleet(Closed(), Answer("open sesame"));
    fleet.Add(RequestFor("uav1"), Year());
    fleet.Renew(fleet.RequestOf("uav1"), Year());
    fleet.RevokeOlder("uav1", Now);
    EXPECT_THAT(_asked, ElementsAre(EndsWith("/authority/key")));
}

TEST_F(PassphraseTest, NobodyIsAskedForAPlainKey)
{
    FleetAuthority(Place(), Answer("")).Add(RequestFor("uav1"), Year());
    EXPECT_THAT(_asked, ElementsAre());
}

TEST_F(PassphraseTest, NobodyIsAskedBeforeThatIsNeeded)
{
    EXPECT_THAT(FleetAuthority(Closed(), Answer("")).Nodes(), ElementsAre());
    EXPECT_THAT(_asked, ElementsAre());
}

TEST_F(PassphraseTest, AWrongPassphraseMakesNothing)
{
    EXPECT_THAT(WhyNot([&] { AddWith(Answer("close sesame")); }), HasSubstr("the passphrase does not open"));
    EXPECT_FALSE(IsMade());
}

TEST_F(PassphraseTest, WithoutAPassphraseNothingIsMade)
{
    EXPECT_THAT(WhyNot([&] { AddWith({}); }), HasSubstr("is encrypted"));
    EXPECT_FALSE(IsMade());
}

TEST_F(PassphraseTest, APassphraseThatIsTooLongIsRefused)
{
    EXPECT_THAT(WhyNot([&] { AddWith(Answer(std::string(LongestPassphrase + 1, 'x'))); }),
                HasSubstr("no passphrase"));
    EXPECT_FALSE(IsMade());
}

TEST_F(PassphraseTest, NothingOfASecretStaysInMemoryAfterItsEnd)
{
    alignas(Secret) std::array<unsigned char, sizeof(Secret)> place{};
    const std::string text = "open sesame";
    std::destroy_at(new (place.data()) Secret(text));
    EXPECT_EQ(std::search(place.begin(), place.end(), text.begin(), text.end()), place.end());
}

TEST_F(PassphraseTest, NothingIsRevokedWithoutThePassphrase)
{
    AddWith(Answer("open sesame"));
    EXPECT_THAT(WhyNot([&] { FleetAuthority(Closed(), Answer("no")).Revoke("uav1", Now); }),
                HasSubstr("the passphrase does not open"));
    EXPECT_TRUE(IsMade());
    EXPECT_EQ(FleetAuthority(Closed()).Epoch(), 1);
}

// As `openssl pkcs8 -topk8 -v2 aes-256-cbc` writes it.
TEST_F(PassphraseTest, AKeyThatOpenSslHasEncryptedIsOpened)
{
    const std::string file = Place() + "/authority/key";
    const KeyPtr key = ReadKey(ReadSecret(file), file);
    const BioPtr bio = EmptyBio();
    ASSERT_EQ(
        PEM_write_bio_PKCS8PrivateKey(bio.get(), key.get(), EVP_aes_256_cbc(), "abc", 3, nullptr, nullptr),
        1);
    WriteSecret(file, TextOf(*bio));
    FleetAuthority(Place(), Answer("abc")).Add(RequestFor("uav1"), Year());
    EXPECT_EQ(MemberFolder(FolderOf("uav1")).WhyNot("uav1"), "");
}

TEST_F(PassphraseTest, AnEncryptedKeyOfANodeIsRefused)
{
    Add("uav1");
    const std::string file = MemberFiles(FolderOf("uav1")).Key;
    const std::string plain = ReadSecret(file);
    const std::string second = plain.substr(plain.find("-----BEGIN", 1));
    WriteSecret(file, SigningKeyPem(MemberSecrets::Read(plain, file).Signing, "abc") + second);
    EXPECT_THAT(WhyNoMember(FolderOf("uav1")), HasSubstr("/key is encrypted"));
}

// OpenSSL would ask for a passphrase at the terminal.
TEST_F(PassphraseTest, NobodyIsAskedForThePassphraseOfFilesThatAreNotSecret)
{
    const auto closed = [](const std::string &kind)
    {
        return "-----BEGIN " + kind + "-----\nProc-Type: 4,ENCRYPTED\nDEK-Info: " +
               "AES-256-CBC,00112233445566778899AABBCCDDEEFF\n\nAAAAAAAAAAAAAAAAAAAAAA==\n-----END " + kind +
               "-----\n";
    };
    EXPECT_THAT(WhyNot([&] { ReadPublicKey(closed("PUBLIC KEY"), "a.pem"); }),
                HasSubstr("a.pem is no public key"));
    EXPECT_THAT(WhyNot([&] { ReadCertificate(closed("CERTIFICATE"), "c.pem"); }),
                HasSubstr("bad password read"));
}

}  // namespace
}  // namespace Rabit::Keys
