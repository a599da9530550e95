#include "keys/MemberFolder.h"

#include <gmock/gmock.h>
#include <rabit/keys/NodeOfKeys.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "FleetFolder.h"
#include "keys/MemberCheck.h"

namespace Rabit::Keys
{
namespace
{

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class MemberFolderTest : public FleetFolder
{
protected:
    MemberFolderTest()
    {
        Add("uav1");
        Add("uav2");
    }

    MemberFiles Files(const std::string &node = "uav1") const { return MemberFiles(FolderOf(node)); }
    // Replaces the file of uav1 by that of the other folder.
    std::string WhyNotWith(const std::string &file, const std::string &other) const
    {
        std::filesystem::copy_file(other + "/" + file, FolderOf("uav1") + "/" + file,
                                   std::filesystem::copy_options::overwrite_existing);
        return WhyNoMember(FolderOf("uav1"));
    }
    std::string OtherFleet() const
    {
        FleetAuthority::Init(Root + "/other");
        FleetAuthority(Root + "/other").Add(RequestFor("uav1"), Year());
        return Root + "/other/uav1";
    }
    // A bulletin of epoch 2, as the node would hear of it.
    Bytes NewerBulletin() const
    {
        Revoke("uav2");
        return MemberFolder(FolderOf("uav1")).Keys().Bulletins.back();
    }
};

TEST_F(MemberFolderTest, IsForOneNameAlone)
{
    EXPECT_THAT(MemberFolder(FolderOf("uav1")).WhyNot("uav2"), HasSubstr("is for the node `uav1`"));
}

TEST_F(MemberFolderTest, TellsTheNodeThatItIsFor)
{
    EXPECT_EQ(NodeOfKeys(FolderOf("uav2")), "uav2");
}

TEST_F(MemberFolderTest, NamesThePermissionsThatAreMissing)
{
    Access access = Needs();
    access.Publish.push_back("Photo");
    access.Subscribe.push_back("*");
    EXPECT_THAT(MemberFolder(FolderOf("uav1")).Lacks(access), ElementsAre("write Photo", "read *"));
}

TEST_F(MemberFolderTest, RefusesAKeyThatOthersMayRead)
{
    std::filesystem::permissions(Files().Key, std::filesystem::perms(0640));
    EXPECT_THAT(WhyNoMember(FolderOf("uav1")), HasSubstr("(mode 640)"));
}

TEST_F(MemberFolderTest, RefusesTheKeyOfAnotherNode)
{
    EXPECT_THAT(WhyNotWith("key", FolderOf("uav2")), HasSubstr("not the key of the certificate"));
}

TEST_F(MemberFolderTest, RefusesThePermissionsOfAnotherNode)
{
    Access more = Needs();
    more.Publish.push_back("Photo");
    FleetAuthority(Place()).Add({.Node = "uav3", .Allowed = PermissionsFor(more)}, Year());
    EXPECT_THAT(WhyNotWith("permissions", FolderOf("uav3")), HasSubstr("does not belong to the certificate"));
}

TEST_F(MemberFolderTest, RefusesTheCertificateOfAnotherFleet)
{
    EXPECT_THAT(WhyNotWith("certificate", OtherFleet()), HasSubstr("not signed by the authority"));
}

TEST_F(MemberFolderTest, RefusesTheBulletinOfAnotherFleet)
{
    EXPECT_THAT(WhyNotWith("bulletin", OtherFleet()), HasSubstr("not signed by the authority"));
}

TEST_F(MemberFolderTest, SaysThatThereIsNoFolder)
{
    EXPECT_THAT(WhyNoMember(Root + "/none"), HasSubstr("there is no folder of keys"));
}

TEST_F(MemberFolderTest, IsNotTheFolderOfTheFleet)
{
    EXPECT_THAT(WhyNoMember(Place()),
                HasSubstr("is the folder of a fleet; name the folder of one node in it"));
}

TEST_F(MemberFolderTest, OfARevokedNodeSaysHowToMakeOthers)
{
    const std::string folder = CopyOf("uav1");
    Revoke("uav1");
    std::filesystem::copy_file(Place() + "/authority/bulletin", MemberFiles(folder).Bulletin,
                               std::filesystem::copy_options::overwrite_existing);
    EXPECT_THAT(MemberFolder(folder).WhyNot("uav1"),
                HasSubstr("is revoked; make new keys with `rabit keys add`"));
    Add("uav1");
    EXPECT_EQ(MemberFolder(FolderOf("uav1")).WhyNot("uav1"), "");
}

TEST_F(MemberFolderTest, NeedsEachFile)
{
    for (const char *name : {"certificate", "permissions", "authority", "bulletin", "key"})
    {
        const std::string file = FolderOf("uav1") + "/" + name;
        std::filesystem::rename(file, Root + "/away");
        EXPECT_THAT(WhyNoMember(FolderOf("uav1")), HasSubstr(file));
        std::filesystem::rename(Root + "/away", file);
    }
    EXPECT_EQ(WhyNoMember(FolderOf("uav1")), "");
}

TEST_F(MemberFolderTest, RefusesAFolderOfTheFormerFormat)
{
    for (const std::string file : {"certificate.pem", "private_key.pem"})
    {
        MakeFormer(Root + "/" + file, file);
        EXPECT_THAT(WhyNoMember(Root + "/" + file), HasSubstr("keys of a former format"));
    }
}

TEST_F(MemberFolderTest, RefusesThePermissionsFromBeforeARenewal)
{
    const std::string before = CopyOf("uav1");
    FleetAuthority(Place()).Renew({.Node = "uav1", .Allowed = PermissionsFor({.Publish = {"Pose"}})}, Year());
    EXPECT_THAT(WhyNotWith("permissions", before), HasSubstr("older than the certificate"));
}

TEST_F(MemberFolderTest, NeedsTheKeyUnlessTheNodeHasIt)
{
    std::filesystem::remove(Files().Key);
    EXPECT_THAT(WhyNoMember(FolderOf("uav1")), HasSubstr("there is no"));
    EXPECT_FALSE(MemberFolder(FolderOf("uav1"), KeyPlace::HereOrOnNode).HasKey());
}

TEST_F(MemberFolderTest, RefusesAnyContentOfAnyFileWithOneLine)
{
    std::mt19937 random(1);
    const std::string folder = FolderOf("uav1");
    for (const char *name : {"certificate", "permissions", "authority", "bulletin", "key"})
    {
        const std::string file = folder + "/" + name;
        const std::string good = ReadFile(file);
        std::vector<std::string> bad{"",
                                     "x",
                                     std::string(1, '\0'),
                                     good.substr(0, good.size() / 2),
                                     "-----BEGIN RABIT BULLETIN-----\n-----END RABIT BULLETIN-----\n",
                                     "-----BEGIN",
                                     good + good};
        for (int i = 0; i < 50; ++i)
        {
            std::string changed = good;
            changed[random() % changed.size()] = static_cast<char>(random() % 256);
            bad.push_back(changed);
        }
        for (const std::string &text : bad)
        {
            Overwrite(file, text);
            const std::string why = WhyNoMember(folder);
            // Some changes are in the text around the bytes, or repeat what is good.
            EXPECT_EQ(std::count(why.begin(), why.end(), '\n'), 0) << name;
        }
        for (std::size_t i = 0; i < 4; ++i)
        {
            Overwrite(file, bad[i]);
            EXPECT_THAT(WhyNoMember(folder), HasSubstr(file));
        }
        Overwrite(file, good);
        EXPECT_EQ(WhyNoMember(folder), "");
    }
}

TEST_F(MemberFolderTest, RefusesChangedBytesInAWholeArmour)
{
    for (const auto &[file, label] :
         {std::pair{Files().Certificate, CertificateLabel}, std::pair{Files().Permissions, PermissionsLabel},
          std::pair{Files().Bulletin, BulletinLabel}})
    {
        const std::string good = ReadFile(file);
        const Bytes bytes = BlockIn(good, label, file);
        for (std::size_t at = 0; at < bytes.size(); ++at)
        {
            Bytes changed = bytes;
            changed[at] ^= 1;
            Overwrite(file, Armoured(label, changed));
            EXPECT_NE(WhyNoMember(FolderOf("uav1")), "") << file << " " << at;
        }
        Overwrite(file, good);
    }
}

TEST_F(MemberFolderTest, StoresANewerBulletinInTheFolder)
{
    const std::string folder = CopyOf("uav1");
    const MemberKeys keys = MemberFolder(folder).Keys();
    const Bytes newer = NewerBulletin();
    EXPECT_TRUE(keys.Store(2, newer));
    const MemberFolder again(folder);
    EXPECT_EQ(again.Epoch(), 2);
    EXPECT_THAT(again.Keys().Bulletins, ElementsAre(keys.Bulletins.front(), newer));
}

TEST_F(MemberFolderTest, KeepsTheBulletinsThatAPersonCopiedMeanwhile)
{
    const std::string folder = CopyOf("uav1");
    const MemberKeys keys = MemberFolder(folder).Keys();
    const Bytes heard = NewerBulletin();
    // Issues both epochs anew.
    Add("uav3");
    std::filesystem::copy_file(Place() + "/authority/bulletin", MemberFiles(folder).Bulletin,
                               std::filesystem::copy_options::overwrite_existing);
    const auto copied = MemberFolder(folder).Keys().Bulletins;
    ASSERT_EQ(copied.size(), 2U);
    ASSERT_NE(copied.back(), heard);
    EXPECT_TRUE(keys.Store(2, heard));
    EXPECT_EQ(MemberFolder(folder).Keys().Bulletins, copied);
}

TEST_F(MemberFolderTest, ReplacesBulletinsOfAnotherFleetThatAPersonCopied)
{
    const std::string folder = CopyOf("uav1");
    const MemberKeys keys = MemberFolder(folder).Keys();
    const Bytes heard = NewerBulletin();
    std::filesystem::copy_file(OtherFleet() + "/bulletin", MemberFiles(folder).Bulletin,
                               std::filesystem::copy_options::overwrite_existing);
    EXPECT_TRUE(keys.Store(2, heard));
    EXPECT_THAT(MemberFolder(folder).Keys().Bulletins, ElementsAre(keys.Bulletins.front(), heard));
}

TEST_F(MemberFolderTest, StoresANewerBulletinElsewhereIfTheFolderCannotBeWritten)
{
    const std::string folder = CopyOf("uav1");
    const std::string elsewhere = Root + "/uav1.bulletin";
    const MemberKeys keys = MemberFolder(folder, KeyPlace::Here, elsewhere).Keys();
    const Bytes newer = NewerBulletin();
    // A folder in the way holds off root, too.
    const std::string before = ReadFile(MemberFiles(folder).Bulletin);
    std::filesystem::remove(MemberFiles(folder).Bulletin);
    std::filesystem::create_directories(MemberFiles(folder).Bulletin + "/in_the_way");
    EXPECT_TRUE(keys.Store(2, newer));
    std::filesystem::remove_all(MemberFiles(folder).Bulletin);
    WriteFile(MemberFiles(folder).Bulletin, before);
    EXPECT_EQ(MemberFolder(folder).Epoch(), 1);
    EXPECT_EQ(MemberFolder(folder, KeyPlace::Here, elsewhere).Epoch(), 2);
}

TEST_F(MemberFolderTest, SaysThatABulletinCouldNotBeStored)
{
    const std::string folder = CopyOf("uav1");
    const MemberKeys keys = MemberFolder(folder).Keys();
    const Bytes newer = NewerBulletin();
    std::filesystem::remove_all(folder);
    EXPECT_FALSE(keys.Store(2, newer));
}

TEST_F(MemberFolderTest, PassesOverStoredBulletinsOfAnotherFleet)
{
    const std::string stored = OtherFleet() + "/bulletin";
    EXPECT_EQ(MemberFolder(FolderOf("uav1"), KeyPlace::Here, stored).WhyNot("uav1"), "");
}

TEST_F(MemberFolderTest, IsNoReasonNotToStartOutsideOfItsDates)
{
    FleetAuthority(Place()).Add(RequestFor("old"), {.Now = Now - 1000 * ADay, .Days = 1});
    const MemberFolder member(FolderOf("old"));
    EXPECT_EQ(member.WhyNot("old"), "");
    const auto findings = WhatEnds(member.Certificate(), Now, 30);
    ASSERT_EQ(findings.size(), 1U);
    EXPECT_THAT(findings.front().Text, HasSubstr("ended on"));
}

TEST_F(MemberFolderTest, WarnsOfDatesAheadAndOfSlowClocks)
{
    const Envelope::Certificate certificate = MemberFolder(FolderOf("uav1")).Certificate();
    EXPECT_THAT(WhatEnds(certificate, Now, 30), IsEmpty());
    EXPECT_THAT(WhatEnds(certificate, Now + 350 * ADay, 30).at(0).Text, HasSubstr("in 15 days; renew it"));
    EXPECT_THAT(WhatEnds(certificate, 0, 30).at(0).Text, HasSubstr("the clock here says 1970-01-01"));
}

TEST_F(MemberFolderTest, SaysItsPermissionsInWords)
{
    const MemberFolder member(FolderOf("uav1"));
    EXPECT_THAT(WhoMayWhat(member.Allowed()),
                ElementsAre("writes rabit/Link, Pose", "reads rabit/Link, Pose"));
    EXPECT_THAT(WhatIsTooMuch(member.Certificate(), member.Allowed()), IsEmpty());
}

TEST_F(MemberFolderTest, FindsPatternsThatNoNodeNeeds)
{
    const auto list = *Envelope::Permissions::Of({{.Topic = "Po*", .MayWrite = true, .MayRead = true}});
    Envelope::Certificate certificate;
    EXPECT_EQ(WhatIsTooMuch(certificate, list).size(), 2U);
    certificate.Role = Envelope::CertificateRole::Tool;
    EXPECT_EQ(WhatIsTooMuch(certificate, list).size(), 1U);
}

}  // namespace
}  // namespace Rabit::Keys
