#include "keys/FleetAuthority.h"

#include <gmock/gmock.h>

#include <set>
#include <string>
#include <vector>

#include "FleetFolder.h"
#include "envelope/Bulletin.h"

namespace Rabit::Keys
{
namespace
{

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class FleetAuthorityTest : public FleetFolder
{
protected:
    // The secret of the newest epoch, as the node reads it from the folder.
    static Envelope::SecretKey::Content SecretIn(const std::string &folder)
    {
        const MemberFolder member(folder);
        const MemberKeys keys = member.Keys();
        Envelope::VerifyingKey authority = VerifyingKeyOf(keys.Authority);
        const auto bulletin = Envelope::Bulletin::Read(keys.Bulletins.back(), authority);
        const Envelope::AgreementKey key = AgreementKeyOf(Envelope::SecretKey(keys.AgreementKey));
        return bulletin->Secret(member.Certificate().Number, key)->Bytes();
    }
};

std::set<std::string> FilesWithPrivateKeys(const std::string &folder)
{
    std::set<std::string> names;
    for (const auto &entry : std::filesystem::recursive_directory_iterator(folder))
    {
        if (entry.is_regular_file() &&
            ReadFile(entry.path().string()).find("PRIVATE KEY") != std::string::npos)
        {
            names.insert(std::filesystem::relative(entry.path(), folder).string());
        }
    }
    return names;
}

TEST_F(FleetAuthorityTest, MakesNodesWhoseKeysFit)
{
    Add("uav1");
    const MemberFolder member(FolderOf("uav1"));
    EXPECT_EQ(member.WhyNot("uav1"), "");
    EXPECT_THAT(member.Lacks(Needs()), IsEmpty());
    EXPECT_EQ(member.Epoch(), 1);
}

TEST_F(FleetAuthorityTest, KeepsPrivateKeysForTheirOwnerAlone)
{
    Add("uav1");
    const std::set<std::string> secret = FilesWithPrivateKeys(Place());
    EXPECT_THAT(secret, ElementsAre("authority/key", "uav1/key"));
    for (const std::string &file : secret)
    {
        EXPECT_EQ(std::filesystem::status(Place() + "/" + file).permissions(),
                  std::filesystem::perms::owner_read | std::filesystem::perms::owner_write)
            << file;
    }
    EXPECT_EQ(std::filesystem::status(FolderOf("uav1")).permissions(), std::filesystem::perms::owner_all);
}

TEST_F(FleetAuthorityTest, IsNotMadeOverAnother)
{
    const std::string before = ReadFile(Place() + "/authority/authority");
    EXPECT_THAT(WhyNot([&] { FleetAuthority::Init(Place()); }), HasSubstr("already"));
    EXPECT_EQ(ReadFile(Place() + "/authority/authority"), before);
}

TEST_F(FleetAuthorityTest, MakesNoNodeOverAnother)
{
    Add("uav1");
    const std::string before = ReadFile(MemberFiles(FolderOf("uav1")).Certificate);
    EXPECT_THAT(WhyNot([&] { Add("uav1"); }), HasSubstr("there already"));
    EXPECT_EQ(ReadFile(MemberFiles(FolderOf("uav1")).Certificate), before);
}

TEST_F(FleetAuthorityTest, RefusesNamesThatWouldLeaveTheFolder)
{
    for (const std::string node : {"..", ".", "authority", "a/b", "", ".uav1", "a\nb"})
    {
        EXPECT_THAT(WhyNot([&] { Add(node); }), HasSubstr("cannot be the name")) << node;
    }
}

TEST_F(FleetAuthorityTest, IsChangedByOneAtATime)
{
    const FleetAuthority one(Place());
    EXPECT_THAT(WhyNot([&] { const FleetAuthority other(Place()); }), HasSubstr("somebody else"));
}

TEST_F(FleetAuthorityTest, RefusesMorePermissionsThanACardHolds)
{
    Access access = Needs();
    for (int i = 0; i < 300; ++i)
    {
        access.Publish.push_back("SomeMessage" + std::to_string(i));
    }
    EXPECT_THAT(WhyNot([&] { PermissionsFor(access); }), HasSubstr("too many topics"));
}

TEST_F(FleetAuthorityTest, MakesNothingWithAKeyThatOthersMayRead)
{
    std::filesystem::permissions(Place() + "/authority/key", std::filesystem::perms(0644));
    EXPECT_THAT(WhyNot([&] { Add("uav1"); }), HasSubstr("not for its owner alone"));
    EXPECT_FALSE(std::filesystem::exists(FolderOf("uav1")));
}

TEST_F(FleetAuthorityTest, MakesNothingWithTheKeyOfAnotherFleet)
{
    FleetAuthority::Init(Root + "/other");
    std::filesystem::copy_file(Root + "/other/authority/key", Place() + "/authority/key",
                               std::filesystem::copy_options::overwrite_existing);
    EXPECT_THAT(WhyNot([&] { Add("uav1"); }), HasSubstr("not the key of the authority"));
}

TEST_F(FleetAuthorityTest, RefusesAFolderOfTheFormerFormat)
{
    const std::string former = Root + "/former";
    MakeFormer(former, "authority/identity.pem");
    const auto told = HasSubstr("keys of a former format");
    EXPECT_THAT(WhyNot([&] { const FleetAuthority fleet(former); }), told);
    EXPECT_THAT(WhyNot([&] { FleetAuthority::Init(former); }), told);
    MakeFormer(former + "/uav1", "certificate.pem");
    EXPECT_THAT(WhyNot([&] { const FleetAuthority fleet(former + "/uav1"); }), told);
    EXPECT_FALSE(std::filesystem::exists(former + "/authority/key"));
}

TEST_F(FleetAuthorityTest, ListsNodesInTheirNaturalOrder)
{
    Add("uav10");
    Add("uav2");
    EXPECT_THAT(FleetAuthority(Place()).Nodes(), ElementsAre("uav2", "uav10"));
}

TEST_F(FleetAuthorityTest, AddsANodeWithoutANewEpochForTheOthers)
{
    Add("uav1");
    const std::string uav1 = CopyOf("uav1");
    Add("uav2");
    EXPECT_EQ(MemberFolder(FolderOf("uav2")).Epoch(), 1);
    EXPECT_EQ(SecretIn(uav1), SecretIn(FolderOf("uav2")));
}

TEST_F(FleetAuthorityTest, GivesANewNodeTheFormerEpochsToo)
{
    Add("uav1");
    Add("uav2");
    Revoke("uav2");
    Add("uav3");
    EXPECT_EQ(MemberFolder(FolderOf("uav3")).Keys().Bulletins.size(), 2U);
}

TEST_F(FleetAuthorityTest, RevokesByAnEpochWhoseSecretTheOthersAloneRead)
{
    Add("uav1");
    Add("uav2");
    const std::string revoked = CopyOf("uav1");
    const auto before = SecretIn(FolderOf("uav2"));
    EXPECT_EQ(Revoke("uav1"), 1U);
    EXPECT_EQ(MemberFolder(FolderOf("uav2")).Epoch(), 2);
    EXPECT_NE(SecretIn(FolderOf("uav2")), before);
    EXPECT_FALSE(std::filesystem::exists(FolderOf("uav1")));
    // The bulletin is public: the revoked node has it, and can make nothing of it.
    std::filesystem::copy_file(MemberFiles(FolderOf("uav2")).Bulletin, MemberFiles(revoked).Bulletin,
                               std::filesystem::copy_options::overwrite_existing);
    const MemberFolder thief(revoked);
    EXPECT_THAT(thief.WhyNot("uav1"), HasSubstr("is revoked"));
    EXPECT_EQ(thief.Keys().Bulletins.size(), 1U);
}

TEST_F(FleetAuthorityTest, ReachesANodeThatGetsTheBulletinAlone)
{
    Add("uav1");
    Add("uav2");
    const std::string flying = CopyOf("uav2");
    Revoke("uav1");
    std::filesystem::copy_file(Place() + "/authority/bulletin", MemberFiles(flying).Bulletin,
                               std::filesystem::copy_options::overwrite_existing);
    EXPECT_EQ(MemberFolder(flying).WhyNot("uav2"), "");
    EXPECT_EQ(SecretIn(flying), SecretIn(FolderOf("uav2")));
}

TEST_F(FleetAuthorityTest, FinishesARevocationThatWasCutShort)
{
    Add("uav1");
    Add("uav2");
    const std::string before = ReadFile(MemberFiles(FolderOf("uav2")).Bulletin);
    Revoke("uav1");
    // As if only the authority's own file had been written.
    WriteFile(MemberFiles(FolderOf("uav2")).Bulletin, before);
    EXPECT_EQ(Revoke("uav1"), 0U);
    EXPECT_EQ(MemberFolder(FolderOf("uav2")).Epoch(), 2);
}

TEST_F(FleetAuthorityTest, KeepsTheRevokedOnesRevokedInLaterEpochs)
{
    for (const std::string node : {"uav1", "uav2", "uav3"})
    {
        Add(node);
    }
    const std::string revoked = CopyOf("uav1");
    Revoke("uav1");
    Revoke("uav2");
    EXPECT_THAT(FleetAuthority(Place()).Revoked(), ElementsAre("uav1", "uav2"));
    std::filesystem::copy_file(MemberFiles(FolderOf("uav3")).Bulletin, MemberFiles(revoked).Bulletin,
                               std::filesystem::copy_options::overwrite_existing);
    EXPECT_THAT(MemberFolder(revoked).WhyNot("uav1"), HasSubstr("is revoked"));
}

TEST_F(FleetAuthorityTest, KeepsTheNewestEightEpochs)
{
    Add("ground");
    for (int i = 0; i < 9; ++i)
    {
        Add("uav" + std::to_string(i));
        Revoke("uav" + std::to_string(i));
    }
    const MemberFolder member(FolderOf("ground"));
    EXPECT_EQ(member.Epoch(), 10);
    EXPECT_EQ(member.Keys().Bulletins.size(), 8U);
}

TEST_F(FleetAuthorityTest, RevokesNoNodeThatItNeverKnew)
{
    EXPECT_THAT(WhyNot([&] { Revoke("uav9"); }), HasSubstr("no certificate was ever made for uav9"));
}

TEST_F(FleetAuthorityTest, RenewsWithAnotherKeyAndSerialAndTheSamePermissions)
{
    Add("uav1");
    const MemberFolder before(FolderOf("uav1"));
    Renew("uav1");
    const MemberFolder after(FolderOf("uav1"));
    EXPECT_NE(after.Certificate().Signing, before.Certificate().Signing);
    EXPECT_NE(after.Certificate().Agreement, before.Certificate().Agreement);
    EXPECT_GT(after.Certificate().Number, before.Certificate().Number);
    EXPECT_EQ(after.Allowed().Rules(), before.Allowed().Rules());
    EXPECT_EQ(after.WhyNot("uav1"), "");
}

TEST_F(FleetAuthorityTest, LeavesTheFormerCertificateGoodUntilItIsRevoked)
{
    Add("uav1");
    const std::string flying = CopyOf("uav1");
    Add("uav2");
    Renew("uav1");
    Revoke("uav2");
    std::filesystem::copy_file(Place() + "/authority/bulletin", MemberFiles(flying).Bulletin,
                               std::filesystem::copy_options::overwrite_existing);
    EXPECT_EQ(MemberFolder(flying).WhyNot("uav1"), "");
    EXPECT_EQ(FleetAuthority(Place()).RevokeOlder("uav1", Now), 1U);
    std::filesystem::copy_file(Place() + "/authority/bulletin", MemberFiles(flying).Bulletin,
                               std::filesystem::copy_options::overwrite_existing);
    EXPECT_THAT(MemberFolder(flying).WhyNot("uav1"), HasSubstr("is revoked"));
    EXPECT_EQ(MemberFolder(FolderOf("uav1")).WhyNot("uav1"), "");
}

TEST_F(FleetAuthorityTest, GivesNoNewSecretToACertificateThatHasEndedAndWasRenewed)
{
    Add("uav1");
    const std::string flying = CopyOf("uav1");
    Add("uav2");
    Renew("uav1");
    FleetAuthority(Place()).Revoke("uav2", Now + 400 * ADay);
    std::filesystem::copy_file(Place() + "/authority/bulletin", MemberFiles(flying).Bulletin,
                               std::filesystem::copy_options::overwrite_existing);
    EXPECT_THAT(MemberFolder(flying).WhyNot("uav1"), HasSubstr("has no secret"));
    EXPECT_EQ(MemberFolder(FolderOf("uav1")).WhyNot("uav1"), "");
}

// Renewing renames the node's folder, and then the new one.
TEST_F(FleetAuthorityTest, PutsTheOldKeysBackAfterARenewalThatWasCutShort)
{
    Add("uav1");
    const std::string key = ReadSecret(MemberFiles(FolderOf("uav1")).Key);
    std::filesystem::rename(FolderOf("uav1"), Place() + "/.uav1.old");
    EXPECT_THAT(FleetAuthority(Place()).Nodes(), ElementsAre("uav1"));
    EXPECT_EQ(ReadSecret(MemberFiles(FolderOf("uav1")).Key), key);
}

TEST_F(FleetAuthorityTest, LeavesTheNewKeysAfterARenewalThatWasCutShortAtItsEnd)
{
    Add("uav1");
    const std::string key = ReadSecret(MemberFiles(FolderOf("uav1")).Key);
    std::filesystem::create_directory(Place() + "/.uav1.old");
    const FleetAuthority fleet(Place());
    EXPECT_EQ(ReadSecret(MemberFiles(FolderOf("uav1")).Key), key);
    EXPECT_FALSE(std::filesystem::exists(Place() + "/.uav1.old"));
}

TEST_F(FleetAuthorityTest, RevokesNoNodeWhoseNameBeginsAlike)
{
    Add("uav1");
    Add("uav1.vision");
    EXPECT_EQ(Revoke("uav1"), 1U);
    EXPECT_EQ(MemberFolder(FolderOf("uav1.vision")).WhyNot("uav1.vision"), "");
}

TEST_F(FleetAuthorityTest, TakesNoCertificateThatItDidNotSign)
{
    FleetAuthority::Init(Root + "/other");
    FleetAuthority(Root + "/other").Add(RequestFor("thief"), Year());
    std::filesystem::copy_file(MemberFiles(Root + "/other/thief").Certificate,
                               Place() + "/authority/issued/9");
    EXPECT_THAT(WhyNot([&] { Add("uav1"); }), HasSubstr("no certificate that the authority signed"));
}

}  // namespace
}  // namespace Rabit::Keys
