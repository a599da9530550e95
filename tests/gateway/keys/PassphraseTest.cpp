#include <gmock/gmock.h>
#include <openssl/pem.h>

#include <algorithm>
#include <array>
#include <memory>
#include <new>

#include "KeysFolder.h"

namespace Rabit::Keys
{
namespace
{

using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;

// A fleet whose authorities have encrypted keys, beside the plain one of KeysFolder.
class PassphraseTest : public KeysFolder
{
protected:
    PassphraseTest() { FleetKeys::Init(Closed(), "red", {.Now = TestNow, .Days = 3650}, "open sesame"); }

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
        FleetKeys(Closed(), std::move(ask)).Add(RequestFor("uav1"), {.Now = TestNow, .Days = 365});
    }
    bool IsMade() const { return std::filesystem::exists(Closed() + "/uav1"); }

    std::vector<std::string> _asked;
};

TEST_F(PassphraseTest, OnlyTheKeysOfTheAuthoritiesAreEncrypted)
{
    AddWith(Answer("open sesame"));
    for (const char *name : {"identity_key.pem", "permissions_key.pem"})
    {
        EXPECT_THAT(ReadSecret(Closed() + "/authority/" + name), HasSubstr("BEGIN ENCRYPTED PRIVATE KEY"));
    }
    EXPECT_EQ(NodeKeys(Closed() + "/uav1").WhyNot("uav1", "fastdds", 7, TestNow), "");
}

TEST_F(PassphraseTest, EachKeyIsOpenedOnce)
{
    const FleetKeys fleet(Closed(), Answer("open sesame"));
    fleet.Add(RequestFor("uav1"), {.Now = TestNow, .Days = 365});
    fleet.Renew(fleet.RequestOf("uav1"), {.Now = TestNow, .Days = 365});
    fleet.RevokeOlder("uav1", TestNow);
    EXPECT_THAT(_asked, ElementsAre(EndsWith("permissions_key.pem"), EndsWith("identity_key.pem")));
}

TEST_F(PassphraseTest, NobodyIsAskedForPlainKeys)
{
    FleetKeys(Place(), Answer("")).Add(RequestFor("uav1"), {.Now = TestNow, .Days = 365});
    EXPECT_THAT(_asked, ElementsAre());
}

TEST_F(PassphraseTest, NobodyIsAskedBeforeThatIsNeeded)
{
    EXPECT_THAT(FleetKeys(Closed(), Answer("")).Nodes(), ElementsAre());
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
    EXPECT_THAT(WhyNot([&] { FleetKeys(Closed(), Answer("no")).Revoke("uav1", TestNow); }),
                HasSubstr("the passphrase does not open"));
    EXPECT_TRUE(IsMade());
}

// As `openssl pkcs8 -topk8 -v2 aes-256-cbc` writes them.
TEST_F(PassphraseTest, KeysThatOpenSslHasEncryptedAreOpened)
{
    const std::string file = Place() + "/authority/identity_key.pem";
    const KeyPtr key = ReadKey(ReadSecret(file), file);
    const BioPtr bio = EmptyBio();
    ASSERT_EQ(
        PEM_write_bio_PKCS8PrivateKey(bio.get(), key.get(), EVP_aes_256_cbc(), "abc", 3, nullptr, nullptr),
        1);
    WriteSecret(file, TextOf(*bio));
    FleetKeys(Place(), Answer("abc")).Add(RequestFor("uav1"), {.Now = TestNow, .Days = 365});
    EXPECT_EQ(NodeKeys(FolderOf("uav1")).WhyNot("uav1", "fastdds", 7, TestNow), "");
}

TEST_F(PassphraseTest, AnEncryptedKeyOfANodeIsRefused)
{
    Add("uav1");
    const std::string file = NodeFiles(FolderOf("uav1")).PrivateKey;
    WriteSecret(file, PemOf(*ReadKey(ReadSecret(file), file), "abc"));
    EXPECT_THAT(WhyNoKeys(FolderOf("uav1")), HasSubstr("private_key.pem is encrypted"));
}

}  // namespace
}  // namespace Rabit::Keys
