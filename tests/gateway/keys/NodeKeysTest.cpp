#include <gmock/gmock.h>

#include "KeysFolder.h"

namespace Rabit::Keys
{
namespace
{

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

class NodeKeysTest : public KeysFolder
{
protected:
    NodeKeysTest() : Files(FolderOf("uav1")) { Add("uav1"); }
    std::string WhyNoUse(std::time_t now = TestNow, const std::string &transport = "fastdds", int domain = 7,
                         const std::string &node = "uav1") const
    {
        return NodeKeys(FolderOf("uav1")).WhyNot(node, transport, domain, now);
    }
    const NodeFiles Files;
};

TEST_F(NodeKeysTest, FreshOnesAreGood)
{
    EXPECT_EQ(WhyNoKeys(FolderOf("uav1")), "");
    EXPECT_EQ(WhyNoUse(), "");
    EXPECT_THAT(NodeKeys(FolderOf("uav1")).Lacks(RequestFor("uav1").Access), IsEmpty());
}

TEST_F(NodeKeysTest, ThatNoFolderIsThereIsSaid)
{
    EXPECT_THAT(WhyNoKeys(Root + "/none"), HasSubstr("there is no folder of keys"));
}

TEST_F(NodeKeysTest, EachFileMustBeThereAndSound)
{
    for (const std::string &file :
         {Files.IdentityAuthority, Files.PermissionsAuthority, Files.Certificate, Files.PrivateKey,
          Files.Revoked, Files.GovernanceSign, Files.GovernanceEncrypt, Files.Permissions})
    {
        const std::string text = ReadFile(file);
        fs::remove(file);
        EXPECT_THAT(WhyNoKeys(FolderOf("uav1")), HasSubstr(file)) << "missing";
        for (const std::size_t size : {std::size_t{0}, text.size() / 2})
        {
            WriteSecret(file, text.substr(0, size));
            EXPECT_THAT(WhyNoKeys(FolderOf("uav1")), HasSubstr(file)) << size;
        }
        WriteSecret(file, text);
        EXPECT_EQ(WhyNoKeys(FolderOf("uav1")), "");
    }
}

TEST_F(NodeKeysTest, WhatIsWrongIsOneLine)
{
    WriteFile(Files.Certificate, "-----BEGIN CERTIFICATE-----\nAAAA\n-----END CERTIFICATE-----\n");
    EXPECT_THAT(WhyNoKeys(FolderOf("uav1")), Not(HasSubstr("\n")));
}

TEST_F(NodeKeysTest, APrivateKeyThatOthersMayReadIsRefused)
{
    fs::permissions(Files.PrivateKey, fs::perms(0640));
    EXPECT_THAT(WhyNoKeys(FolderOf("uav1")),
                HasSubstr("private_key.pem is not for its owner alone (mode 640)"));
}

TEST_F(NodeKeysTest, TheKeyOfAnotherCertificateIsRefused)
{
    Add("uav2");
    WriteSecret(Files.PrivateKey, ReadSecret(NodeFiles(FolderOf("uav2")).PrivateKey));
    EXPECT_THAT(WhyNoKeys(FolderOf("uav1")), HasSubstr("is not the key of the certificate"));
}

TEST_F(NodeKeysTest, ACertificateOfAnotherFleetIsRefused)
{
    FleetKeys::Init(Root + "/other", "blue", {.Now = TestNow, .Days = 3650});
    WriteFile(Files.IdentityAuthority, ReadFile(Root + "/other/authority/identity.pem"));
    EXPECT_THAT(WhyNoKeys(FolderOf("uav1")), HasSubstr("another fleet"));
}

TEST_F(NodeKeysTest, OneAuthorityForBothIsRefused)
{
    WriteFile(Files.PermissionsAuthority, ReadFile(Files.IdentityAuthority));
    EXPECT_THAT(WhyNoKeys(FolderOf("uav1")), HasSubstr("are of one authority"));
}

TEST_F(NodeKeysTest, PermissionsOfAnotherNodeAreRefused)
{
    Add("uav2");
    WriteFile(Files.Permissions, ReadFile(NodeFiles(FolderOf("uav2")).Permissions));
    EXPECT_THAT(WhyNoKeys(FolderOf("uav1")), HasSubstr("permissions of another node"));
}

TEST_F(NodeKeysTest, PermissionsFromBeforeARenewalAreRefused)
{
    const std::string old = ReadFile(Files.Permissions);
    {
        const FleetKeys fleet(Place());
        fleet.Renew(fleet.RequestOf("uav1"), {.Now = TestNow, .Days = 10});
    }
    WriteFile(Files.Permissions, old);
    EXPECT_THAT(WhyNoKeys(FolderOf("uav1")), HasSubstr("older than the certificate"));
}

TEST_F(NodeKeysTest, PermissionsSignedByTheIdentityAuthorityAreRefused)
{
    Rewrite(Files.Permissions, "", "", "identity");
    EXPECT_THAT(WhyNoKeys(FolderOf("uav1")), HasSubstr("not signed by the permissions authority"));
}

TEST_F(NodeKeysTest, ChangedPermissionsAreRefused)
{
    std::string text = ReadFile(Files.Permissions);
    text.replace(text.find("Pose"), 4, "Rose");
    WriteFile(Files.Permissions, text);
    EXPECT_THAT(WhyNoKeys(FolderOf("uav1")), HasSubstr("or was changed"));
}

TEST_F(NodeKeysTest, AGovernanceThatLetsStrangersInIsRefusedThoughItIsSigned)
{
    Rewrite(Files.GovernanceEncrypt, "<allow_unauthenticated_participants>false",
            "<allow_unauthenticated_participants>true");
    EXPECT_THAT(WhyNoKeys(FolderOf("uav1")), HasSubstr("governance_encrypt.p7s does not say"));
}

TEST_F(NodeKeysTest, AClockBeforeTheFirstDayIsOneLineThatSaysWhatToDo)
{
    EXPECT_EQ(WhyNoUse(3600), "the clock says 1970-01-01, and " + Files.Certificate +
                                  " is valid from 2026-11-22: set the clock (an aircraft without a battery "
                                  "clock needs GPS or network time before it starts), then start again");
}

TEST_F(NodeKeysTest, AClockADayBehindIsGood)
{
    EXPECT_EQ(WhyNoUse(TestNow - TestDay + 1), "");
}

TEST_F(NodeKeysTest, ACertificateThatEndedIsSaid)
{
    EXPECT_THAT(WhyNoUse(TestNow + 366 * TestDay), HasSubstr("ended on 2027-11-23"));
}

TEST_F(NodeKeysTest, TheKeysOfAnotherNodeAreRefused)
{
    EXPECT_THAT(WhyNoUse(TestNow, "fastdds", 7, "uav2"),
                HasSubstr("is for the node `uav1`, and this is `uav2`"));
}

TEST_F(NodeKeysTest, KeysForAnotherBackendAreRefused)
{
    EXPECT_THAT(WhyNoUse(TestNow, "cyclonedds"), HasSubstr("another DDS implementation than `cyclonedds`"));
}

TEST_F(NodeKeysTest, AnotherDomainIsRefused)
{
    EXPECT_THAT(WhyNoUse(TestNow, "fastdds", 8), HasSubstr("not for domain 8"));
}

TEST_F(NodeKeysTest, ARevokedOneIsRefused)
{
    Add("uav2");
    fs::copy(FolderOf("uav1"), Root + "/kept");
    FleetKeys(Place()).Revoke("uav1", TestNow);
    WriteFile(Root + "/kept/revoked.pem", ReadFile(NodeFiles(FolderOf("uav2")).Revoked));
    EXPECT_THAT(NodeKeys(Root + "/kept").WhyNot("uav1", "fastdds", 7, TestNow), HasSubstr("is revoked"));
}

constexpr Validity SomeYears{.From = TestNow - TestDay, .To = TestNow + 3650 * TestDay};

TEST_F(NodeKeysTest, AListOfRevokedOnesOfAnotherFleetIsRefused)
{
    FleetKeys::Init(Root + "/other", "blue", {.Now = TestNow, .Days = 3650});
    Relist(FolderOf("uav1"), Root + "/other", "identity", SomeYears);
    EXPECT_THAT(WhyNoKeys(FolderOf("uav1")),
                HasSubstr(Files.Revoked + " is not signed by the identity authority"));
}

TEST_F(NodeKeysTest, AListOfRevokedOnesOfThePermissionsAuthorityIsRefused)
{
    Relist(FolderOf("uav1"), Place(), "permissions", SomeYears);
    EXPECT_THAT(WhyNoKeys(FolderOf("uav1")),
                HasSubstr(Files.Revoked + " is not signed by the identity authority"));
}

TEST_F(NodeKeysTest, AChangedListOfRevokedOnesIsRefused)
{
    const RevocationsPtr list = ReadRevocations(ReadFile(Files.Revoked), "");
    const BioPtr binary = EmptyBio();
    ASSERT_EQ(i2d_X509_CRL_bio(binary.get(), list.get()), 1);
    std::string bytes = TextOf(*binary);
    bytes.back() ^= 1;  // of the signature
    const BioPtr changed = BioOf(bytes);
    const RevocationsPtr other(d2i_X509_CRL_bio(changed.get(), nullptr));
    ASSERT_TRUE(other);
    WriteFile(Files.Revoked, PemOf(*other));
    EXPECT_THAT(WhyNoKeys(FolderOf("uav1")), HasSubstr(Files.Revoked + " is not signed"));
}

TEST_F(NodeKeysTest, AListOfRevokedOnesThatHasNotBegunIsOneLineThatSaysWhatToDo)
{
    Relist(FolderOf("uav1"), Place(), "identity", {.From = TestNow + 600, .To = SomeYears.To});
    EXPECT_EQ(WhyNoUse(), "the clock says 2026-11-23 12:00 UTC, and " + Files.Revoked +
                              " is valid from 2026-11-23 12:10 UTC: set the clock (an aircraft without a "
                              "battery clock needs GPS or network time before it starts), then start again");
}

TEST_F(NodeKeysTest, AListOfRevokedOnesThatEndedIsSaid)
{
    Relist(FolderOf("uav1"), Place(), "identity", {.From = SomeYears.From, .To = TestNow - 1});
    EXPECT_THAT(WhyNoUse(), HasSubstr(Files.Revoked + " ended on 2026-11-23"));
}

TEST_F(NodeKeysTest, AClockADayBehindIsGoodAfterAnotherWasRevoked)
{
    Add("uav2");
    FleetKeys(Place()).Revoke("uav2", TestNow);
    EXPECT_EQ(WhyNoUse(TestNow - TestDay + 1), "");
}

TEST_F(NodeKeysTest, WhatTheConfigurationNeedsBesidesIsNamed)
{
    Access needs = RequestFor("uav1").Access;
    needs.Publish.push_back({"Photo", {"", "uav1"}});
    needs.Subscribe.push_back({"Mission", {"ground", "uav2"}});
    needs.Subscribe.push_back({"Pose", {"*"}});
    EXPECT_THAT(NodeKeys(FolderOf("uav1")).Lacks(needs),
                ElementsAre("write Photo of uav1", "read Mission of ground, uav2", "read Pose of *"));
}

}  // namespace
}  // namespace Rabit::Keys
