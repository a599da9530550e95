#include "keys/MemberRequest.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "FleetFolder.h"

namespace Rabit::Keys
{
namespace
{

using testing::HasSubstr;

class MemberRequestTest : public FleetFolder
{
protected:
    // Makes a request on a node whose folder is `<folder>`, and reads it.
    MemberRequest RequestOf(const std::string &node, const std::string &folder) const
    {
        const RequestedMember made = RequestMember(Root + "/" + folder, node);
        return ReadMemberRequest(ReadFile(made.File), made.File);
    }
    MemberRequest RequestOf(const std::string &node) const { return RequestOf(node, "on_" + node); }
    void Sign(const MemberRequest &signing) const
    {
        FleetAuthority(Place()).Add(RequestFor(signing.Node), Year(), &signing);
    }
    // The request as armour, with a signature of its own.
    static std::string Signed(Bytes content, const MemberSecrets &secrets)
    {
        const std::string context = "Rabit request 1";
        Bytes said(context.begin(), context.end());
        said.insert(said.end(), content.begin(), content.end());
        const auto signature = SigningKeyOf(secrets.Signing).Sign(said);
        content.insert(content.end(), signature->begin(), signature->end());
        return Armoured(RequestLabel, content);
    }
    // The bytes of a request, without their signature.
    static Bytes ContentOf(const std::string &node, const MemberSecrets &secrets)
    {
        Bytes bytes = BlockIn(MakeMemberRequest(node, secrets), RequestLabel, "r.pem");
        bytes.resize(bytes.size() - sizeof(Envelope::Signature));
        return bytes;
    }
    static std::string WhyUnread(const std::string &text)
    {
        return WhyNot([&] { ReadMemberRequest(text, "r.pem"); });
    }
};

TEST_F(MemberRequestTest, LeavesThePrivateKeyOnTheNode)
{
    Sign(RequestOf("uav1"));
    EXPECT_FALSE(std::filesystem::exists(MemberFiles(FolderOf("uav1")).Key));
    EXPECT_EQ(std::filesystem::status(MemberFiles(Root + "/on_uav1").Key).permissions(),
              std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
    EXPECT_EQ(MemberFolder(CopyOf("uav1")).WhyNot("uav1"), "");
}

TEST_F(MemberRequestTest, KeepsTheKeyOfANodeThatAsksAgain)
{
    EXPECT_EQ(RequestOf("uav1").Keys, RequestOf("uav1").Keys);
}

TEST_F(MemberRequestTest, ShowsTheKeyThatItHas)
{
    const RequestedMember made = RequestMember(Root + "/on_uav1", "uav1");
    EXPECT_EQ(made.Fingerprint, RequestOf("uav1").Keys.Fingerprint());
    EXPECT_EQ(made.Fingerprint.size(), 64U);
}

TEST_F(MemberRequestTest, IsNotMadeInTheFolderOfTheFleet)
{
    EXPECT_THAT(WhyNot([&] { RequestMember(Place(), "uav1"); }), HasSubstr("the authority of a fleet"));
}

TEST_F(MemberRequestTest, IsAskedForBeforeTheNodeStarts)
{
    RequestOf("uav1");
    EXPECT_THAT(WhyNoMember(Root + "/on_uav1"), HasSubstr("copy the files"));
}

TEST_F(MemberRequestTest, ThatWasChangedIsRefused)
{
    const RequestedMember made = RequestMember(Root + "/on_uav1", "uav1");
    const Bytes good = BlockIn(ReadFile(made.File), RequestLabel, made.File);
    for (std::size_t at = 0; at < good.size(); ++at)
    {
        Bytes changed = good;
        changed[at] ^= 1;
        EXPECT_THAT(WhyUnread(Armoured(RequestLabel, changed)), HasSubstr("r.pem")) << at;
    }
    for (const std::string text : {"", "bad", "-----BEGIN RABIT REQUEST-----\n"})
    {
        EXPECT_THAT(WhyUnread(text), HasSubstr("r.pem")) << text;
    }
    EXPECT_THAT(WhyUnread(std::string(20000, 'x')), HasSubstr("larger than 16 KiB"));
}

TEST_F(MemberRequestTest, OfTheFormerFormatIsRefused)
{
    EXPECT_THAT(WhyUnread("-----BEGIN CERTIFICATE REQUEST-----\nMIH4\n-----END CERTIFICATE REQUEST-----\n"),
                testing::AllOf(HasSubstr("r.pem is a request of a former format"),
                               HasSubstr("`rabit keys request`")));
}

TEST_F(MemberRequestTest, IsCheckedWithTheOthersBeforeTheFirstIsSigned)
{
    const auto why = [&](const std::vector<MemberRequest> &requests)
    { return WhyNot([&] { FleetAuthority(Place()).CheckAdd(requests); }); };
    const MemberRequest first = RequestOf("uav1", "disk");
    const MemberRequest second = RequestOf("uav2");
    EXPECT_EQ(why({first, second}), "");
    EXPECT_THAT(why({second, first, second}), HasSubstr("two of the requests are of `uav2`"));
    EXPECT_THAT(why({first, RequestOf("uav3", "disk")}), HasSubstr("uav1 and uav3 have the same key"));
    Add("uav2");
    EXPECT_THAT(why({first, second}), HasSubstr("there already"));
}

TEST_F(MemberRequestTest, WithAKeyToWhichNothingCanBeSealedIsRefused)
{
    // A point of low order: all owners would share one secret with it (RFC 7748, 6.1).
    const MemberSecrets secrets = MemberSecrets::Random();
    Bytes content = ContentOf("uav1", secrets);
    std::fill_n(content.begin() + 33, 32, std::uint8_t{0});
    EXPECT_THAT(WhyUnread(Signed(content, secrets)), HasSubstr("nothing can be sealed"));
}

TEST_F(MemberRequestTest, WithANameThatNoNodeCanHaveIsRefused)
{
    const MemberSecrets secrets = MemberSecrets::Random();
    for (const std::string name : {"../x", ".uav", "a/bc", "a\nbc", "uav "})
    {
        Bytes content = ContentOf("uav1", secrets);
        std::copy(name.begin(), name.end(), content.end() - 4);
        EXPECT_THAT(WhyUnread(Signed(content, secrets)),
                    testing::AllOf(HasSubstr("r.pem: "), HasSubstr("cannot be the name")))
            << name;
    }
}

TEST_F(MemberRequestTest, SignedByAnotherKeyIsRefused)
{
    const Bytes content = ContentOf("uav1", MemberSecrets::Random());
    EXPECT_THAT(WhyUnread(Signed(content, MemberSecrets::Random())), HasSubstr("is not signed by the key"));
}

TEST_F(MemberRequestTest, IsNotMadeOfAKeyThatOthersMayRead)
{
    RequestOf("uav1");
    std::filesystem::permissions(MemberFiles(Root + "/on_uav1").Key, std::filesystem::perms(0640));
    EXPECT_THAT(WhyNot([&] { RequestOf("uav1"); }), HasSubstr("(mode 640)"));
}

TEST_F(MemberRequestTest, IsNotMadeInAFolderOfTheFormerFormat)
{
    MakeFormer(Root + "/on_uav1", "private_key.pem");
    EXPECT_THAT(WhyNot([&] { RequestOf("uav1"); }), HasSubstr("keys of a former format"));
}

TEST_F(MemberRequestTest, DoesNotReplaceTheKeysOfANode)
{
    Add("uav1");
    EXPECT_THAT(WhyNot([&] { Sign(RequestOf("uav1")); }), HasSubstr("there already"));
}

TEST_F(MemberRequestTest, OfAnotherNodeRenewsNothing)
{
    Add("uav1");
    const MemberRequest other = RequestOf("uav2");
    EXPECT_THAT(WhyNot([&] { Renew("uav1", &other); }), HasSubstr("is of `uav2`"));
}

TEST_F(MemberRequestTest, WithTheKeyOfAnotherNodeIsRefused)
{
    Sign(RequestOf("uav1", "disk"));
    EXPECT_THAT(WhyNot([&] { Sign(RequestOf("uav2", "disk")); }), HasSubstr("has the key of uav1"));
}

TEST_F(MemberRequestTest, WithARevokedKeyIsRefused)
{
    Sign(RequestOf("uav1"));
    Revoke("uav1");
    EXPECT_THAT(WhyNot([&] { Sign(RequestOf("uav1")); }), HasSubstr("certificate is revoked"));
}

TEST_F(MemberRequestTest, ARevokedKeyIsNotRenewed)
{
    const MemberRequest request = RequestOf("uav1");
    Sign(request);
    // As if the revocation had been cut short before the node's folder was removed.
    const std::string folder = CopyOf("uav1");
    Revoke("uav1");
    std::filesystem::copy(folder, FolderOf("uav1"));
    std::filesystem::remove(MemberFiles(FolderOf("uav1")).Key);
    EXPECT_THAT(WhyNot([&] { Renew("uav1"); }), HasSubstr("certificate is revoked"));
    EXPECT_THAT(WhyNot([&] { Renew("uav1", &request); }), HasSubstr("certificate is revoked"));
}

TEST_F(MemberRequestTest, ANodeWithKeysOfTheAuthorityMayChangeToItsOwn)
{
    Add("uav1");
    const MemberRequest own = RequestOf("uav1");
    FleetAuthority(Place()).CheckNewKey("uav1", &own);
    Renew("uav1", &own);
    EXPECT_FALSE(std::filesystem::exists(MemberFiles(FolderOf("uav1")).Key));
    EXPECT_EQ(FleetAuthority(Place()).RevokeOlder("uav1", Now), 1U);
    EXPECT_EQ(MemberFolder(CopyOf("uav1")).WhyNot("uav1"), "");
}

TEST_F(MemberRequestTest, RenewingKeepsTheKeyOfTheNode)
{
    Sign(RequestOf("uav1"));
    Renew("uav1");
    EXPECT_EQ(MemberFolder(CopyOf("uav1")).WhyNot("uav1"), "");
}

TEST_F(MemberRequestTest, RenewingWithAnotherBringsAnotherKey)
{
    Sign(RequestOf("uav1"));
    const MemberRequest second = RequestOf("uav1", "again");
    Renew("uav1", &second);
    EXPECT_EQ(MemberFolder(FolderOf("uav1"), KeyPlace::HereOrOnNode).Certificate().Signing,
              second.Keys.Signing);
}

TEST_F(MemberRequestTest, AKeptKeyMakesRevokingTheOlderCertificatesPointless)
{
    Sign(RequestOf("uav1"));
    EXPECT_THAT(WhyNot([&] { FleetAuthority(Place()).CheckNewKey("uav1"); }), HasSubstr("keeps its key"));
    Renew("uav1");
    EXPECT_THAT(WhyNot([&] { FleetAuthority(Place()).RevokeOlder("uav1", Now); }),
                HasSubstr("keeps its key"));
    EXPECT_EQ(FleetAuthority(Place()).Epoch(), 1);
}

}  // namespace
}  // namespace Rabit::Keys
