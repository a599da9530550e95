#include <gmock/gmock.h>

#include "KeysFolder.h"
#include "keys/Certificates.h"

namespace Rabit::Keys
{
namespace
{

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class FleetKeysTest : public KeysFolder
{
};

std::vector<std::string> FilesOf(const std::string &folder)
{
    std::vector<std::string> names;
    for (const auto &entry : fs::recursive_directory_iterator(folder))
    {
        names.push_back(entry.path().string());
    }
    return names;
}

TEST_F(FleetKeysTest, PrivateKeysAreForTheirOwnerAlone)
{
    Add("uav1");
    int secrets = 0;
    for (const std::string &file : FilesOf(Place()))
    {
        std::ifstream stream(file);
        std::stringstream text;
        text << stream.rdbuf();
        if (text.str().find("PRIVATE KEY") != std::string::npos)
        {
            ++secrets;
            EXPECT_EQ(fs::status(file).permissions(), fs::perms::owner_read | fs::perms::owner_write) << file;
        }
    }
    EXPECT_EQ(secrets, 3);
    EXPECT_EQ(fs::status(FolderOf("uav1")).permissions(), fs::perms::owner_all);
}

TEST_F(FleetKeysTest, NoKeyOfAnAuthorityIsInANodesFolder)
{
    Add("uav1");
    const std::string place = Place() + "/authority/";
    for (const std::string &file : FilesOf(FolderOf("uav1")))
    {
        for (const char *authority : {"identity_key.pem", "permissions_key.pem"})
        {
            EXPECT_NE(ReadFile(file), ReadFile(place + authority)) << file;
        }
    }
}

TEST_F(FleetKeysTest, IdentityAndPermissionsAreOfTwoAuthorities)
{
    const std::string place = Place() + "/authority/";
    EXPECT_NE(ReadFile(place + "identity_key.pem"), ReadFile(place + "permissions_key.pem"));
}

TEST_F(FleetKeysTest, AFleetIsNotMadeOverAnother)
{
    const std::string before = ReadFile(Place() + "/authority/identity.pem");
    EXPECT_THAT(WhyNot([&] { FleetKeys::Init(Place(), "red", {TestNow, 10}); }), HasSubstr("already"));
    EXPECT_EQ(ReadFile(Place() + "/authority/identity.pem"), before);
}

TEST_F(FleetKeysTest, ANodeIsNotMadeOverAnother)
{
    Add("uav1");
    const std::string before = ReadFile(NodeFiles(FolderOf("uav1")).Certificate);
    EXPECT_THAT(WhyNot([&] { Add("uav1"); }), HasSubstr("there already"));
    EXPECT_EQ(ReadFile(NodeFiles(FolderOf("uav1")).Certificate), before);
}

TEST_F(FleetKeysTest, NamesThatWouldLeaveTheFolderAreRefused)
{
    for (const std::string node : {"..", ".", "authority", "a/b", "", ".uav1", "a\nb"})
    {
        EXPECT_THAT(WhyNot([&] { Add(node); }), HasSubstr("cannot be the name")) << node;
    }
}

TEST_F(FleetKeysTest, ACertificateDoesNotOutliveItsAuthority)
{
    EXPECT_THAT(WhyNot([&] { Add("uav1", "fastdds", TestNow, 4000); }), HasSubstr("fewer days"));
}

TEST_F(FleetKeysTest, PermissionsThatNoVendorCanShowAreRefused)
{
    FleetKeys::Request request = RequestFor("uav1");
    for (int i = 0; i < 500; ++i)
    {
        request.Access.Publish.push_back({"SomeMessage" + std::to_string(i), {"", "uav1"}});
    }
    EXPECT_THAT(WhyNot(
                    [&] {
                        FleetKeys(Place()).Add(request, {TestNow, 10});
                    }),
                HasSubstr("too many topics"));
    EXPECT_FALSE(fs::exists(FolderOf("uav1")));
}

TEST_F(FleetKeysTest, TwoDoNotChangeAFleetAtOnce)
{
    const FleetKeys one(Place());
    EXPECT_THAT(WhyNot([&] { const FleetKeys other(Place()); }), HasSubstr("somebody else"));
}

TEST_F(FleetKeysTest, RenewingGivesAnotherKeyAndAnotherSubject)
{
    Add("uav1");
    const NodeFiles files(FolderOf("uav1"));
    const std::string key = ReadSecret(files.PrivateKey);
    const unsigned number = NodeKeys(FolderOf("uav1")).Subject().Number;
    const FleetKeys fleet(Place());
    fleet.Renew(fleet.RequestOf("uav1"), {.Now = TestNow, .Days = 10});
    EXPECT_NE(ReadSecret(files.PrivateKey), key);
    EXPECT_GT(NodeKeys(FolderOf("uav1")).Subject().Number, number);
}

TEST_F(FleetKeysTest, NodesAreListedInTheirNaturalOrder)
{
    Add("uav10");
    Add("uav2");
    EXPECT_THAT(FleetKeys(Place()).Nodes(), ElementsAre("uav2", "uav10"));
}

// Renewing renames the node's folder, and then the new one.
TEST_F(FleetKeysTest, ARenewalThatWasCutShortLeavesTheOldKeys)
{
    Add("uav1");
    const std::string key = ReadSecret(NodeFiles(FolderOf("uav1")).PrivateKey);
    fs::rename(FolderOf("uav1"), Place() + "/.uav1.old");
    const FleetKeys fleet(Place());
    EXPECT_THAT(fleet.Nodes(), ElementsAre("uav1"));
    EXPECT_EQ(ReadSecret(NodeFiles(FolderOf("uav1")).PrivateKey), key);
    fleet.Renew(fleet.RequestOf("uav1"), {.Now = TestNow, .Days = 10});
    EXPECT_NE(ReadSecret(NodeFiles(FolderOf("uav1")).PrivateKey), key);
    EXPECT_FALSE(fs::exists(Place() + "/.uav1.old"));
}

TEST_F(FleetKeysTest, ARenewalThatWasCutShortAtItsEndLeavesTheNewKeysAlone)
{
    Add("uav1");
    const std::string key = ReadSecret(NodeFiles(FolderOf("uav1")).PrivateKey);
    fs::create_directory(Place() + "/.uav1.old");
    const FleetKeys fleet(Place());
    EXPECT_EQ(ReadSecret(NodeFiles(FolderOf("uav1")).PrivateKey), key);
    EXPECT_FALSE(fs::exists(Place() + "/.uav1.old"));
}

TEST_F(FleetKeysTest, RenewingKeepsWhatTheNodeMay)
{
    Add("uav1", "cyclonedds");
    const FleetKeys fleet(Place());
    fleet.Renew(fleet.RequestOf("uav1"), {.Now = TestNow, .Days = 10});
    const NodeKeys keys(FolderOf("uav1"));
    EXPECT_THAT(keys.Lacks(RequestFor("uav1").Access), IsEmpty());
    EXPECT_EQ(keys.WhyNot("uav1", "cyclonedds", 7, TestNow), "");
}

TEST_F(FleetKeysTest, OfANodeWithADotInItsNameTheOthersCertificatesAreNotTaken)
{
    Add("uav1");
    Add("uav1.vision");
    const FleetKeys fleet(Place());
    EXPECT_EQ(fleet.Revoke("uav1", TestNow), 1U);
    EXPECT_EQ(NodeKeys(FolderOf("uav1.vision")).WhyNot("uav1.vision", "fastdds", 7, TestNow), "");
}

TEST_F(FleetKeysTest, WhoIsRevokedIsInTheListOfEachNodeAndHasNoFolder)
{
    Add("uav1");
    Add("uav2");
    const CertificatePtr certificate = ReadCertificate(ReadFile(NodeFiles(FolderOf("uav1")).Certificate), "");
    EXPECT_EQ(FleetKeys(Place()).Revoke("uav1", TestNow), 1U);
    const RevocationsPtr list = ReadRevocations(ReadFile(NodeFiles(FolderOf("uav2")).Revoked), "");
    EXPECT_TRUE(IsRevoked(*list, *certificate));
    EXPECT_FALSE(fs::exists(FolderOf("uav1")));
    EXPECT_THAT(FleetKeys(Place()).Nodes(), ElementsAre("uav2"));
}

// Nodes check the dates of the list by clocks that may be as slow as the certificates allow.
TEST_F(FleetKeysTest, TheListOfRevokedOnesIsValidAsLongAsTheAuthority)
{
    Add("uav1");
    Add("uav2");
    const CertificatePtr authority = ReadCertificate(ReadFile(Place() + "/authority/identity.pem"), "");
    const std::string file = NodeFiles(FolderOf("uav2")).Revoked;
    for (const bool isRevoked : {false, true})
    {
        if (isRevoked)
        {
            FleetKeys(Place()).Revoke("uav1", TestNow + 100 * TestDay);
        }
        const Validity validity = ValidityOf(*ReadRevocations(ReadFile(file), file));
        EXPECT_EQ(validity.From, ValidityOf(*authority).From);
        EXPECT_EQ(validity.To, ValidityOf(*authority).To);
    }
}

TEST_F(FleetKeysTest, RevokingTheOlderOnesLeavesTheNewestGood)
{
    Add("uav1");
    const FleetKeys fleet(Place());
    fleet.Renew(fleet.RequestOf("uav1"), {.Now = TestNow, .Days = 10});
    EXPECT_EQ(fleet.RevokeOlder("uav1", TestNow), 1U);
    EXPECT_EQ(fleet.RevokeOlder("uav1", TestNow), 0U);
    EXPECT_EQ(NodeKeys(FolderOf("uav1")).WhyNot("uav1", "fastdds", 7, TestNow), "");
}

TEST_F(FleetKeysTest, WithoutTheAuthoritiesKeyNothingIsMade)
{
    fs::permissions(Place() + "/authority/identity_key.pem", fs::perms(0644));
    EXPECT_THAT(WhyNot([&] { Add("uav1"); }), HasSubstr("not for its owner alone"));
    EXPECT_FALSE(fs::exists(FolderOf("uav1")));
}

}  // namespace
}  // namespace Rabit::Keys
