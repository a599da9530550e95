#include "keys/MemberRequest.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cstdint>
#include <string>

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
    EXPECT_THAT(WhyNot([&] { RequestMember(Place(), "uav1"); }), HasSubstr("authorities"));
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

TEST_F(MemberRequestTest, WithAKeyToWhichNothingCanBeSealedIsRefused)
{
    // A point of low order: all owners would share one secret with it (RFC 7748, 6.1).
    const MemberSecrets secrets = MemberSecrets::Random();
    const std::string file = Root + "/r";
    Bytes bytes = BlockIn(MakeMemberRequest("uav1", secrets), RequestLabel, file);
    bytes.resize(bytes.size() - sizeof(Envelope::Signature));
    std::fill_n(bytes.begin() + 33, 32, std::uint8_t{0});
    const std::string context = "Rabit request 1";
    Bytes said(context.begin(), context.end());
    said.insert(said.end(), bytes.begin(), bytes.end());
    const auto signature = SigningKeyOf(secrets.Signing).Sign(said);
    bytes.insert(bytes.end(), signature->begin(), signature->end());
    EXPECT_THAT(WhyUnread(Armoured(RequestLabel, bytes)), HasSubstr("nothing can be sealed"));
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
