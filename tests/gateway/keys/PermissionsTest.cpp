#include "keys/Permissions.h"

#include <gmock/gmock.h>

#include "keys/KeysError.h"

namespace Rabit::Keys
{
namespace
{

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

const SubjectName Uav1{.Fleet = "blue", .Number = 3, .Node = "uav1"};
const Validity SomeTime{.From = 1000000000, .To = 1100000000};

Permissions ReadBack(const Access &access)
{
    return ReadPermissions(PermissionsText(Uav1, SomeTime, access), "file").front();
}

TEST(Permissions, SayExactlyWhatWasAskedFor)
{
    const Access access{.Domain = 7,
                        .Publish = {{"rabit/Link", {""}}, {"Pose", {"", "uav1"}}, {"State", {"", "uav1"}}},
                        .Subscribe = {{"Pose", {"uav*", "ground"}}}};
    const Permissions read = ReadBack(access);
    EXPECT_EQ(read.Subject, "CN=uav1,OU=3,O=blue");
    ASSERT_EQ(read.Rules.size(), 1U);
    EXPECT_THAT(read.Rules[0].Domains, ElementsAre(std::pair(7, 7)));
    EXPECT_EQ(read.Rules[0].Publish, access.Publish);
    EXPECT_EQ(read.Rules[0].Subscribe, access.Subscribe);
    EXPECT_FALSE(read.AllowsTheRest);
}

TEST(Permissions, AreForThatTopicAndThatPartitionAlone)
{
    const Permissions read =
        ReadBack({.Domain = 7, .Publish = {{"Pose", {"", "uav1"}}}, .Subscribe = {{"Mission", {"uav?"}}}});
    EXPECT_TRUE(read.MayPublish(7, {"Pose", {"", "uav1"}}));
    EXPECT_TRUE(read.MayPublish(7, {"Pose", {"uav1"}}));
    EXPECT_FALSE(read.MayPublish(7, {"Pose", {"", "uav2"}}));
    EXPECT_FALSE(read.MayPublish(7, {"Poses", {"uav1"}}));
    EXPECT_FALSE(read.MayPublish(8, {"Pose", {"uav1"}}));
    EXPECT_FALSE(read.MayPublish(7, {"Mission", {"uav1"}}));
    EXPECT_TRUE(read.MaySubscribe(7, {"Mission", {"uav2"}}));
    EXPECT_FALSE(read.MaySubscribe(7, {"Mission", {"ground"}}));
    EXPECT_FALSE(read.MaySubscribe(7, {"Pose", {"uav1"}}));
}

TEST(Permissions, WhatAnEarlierRuleForbidsALaterOneDoesNotAllow)
{
    const std::string rules =
        "<deny_rule><domains><id>7</id></domains><publish><topics><topic>Pose</topic>"
        "</topics></publish></deny_rule>";
    std::string text =
        PermissionsText(Uav1, SomeTime, {.Domain = 7, .Publish = {{"Pose", {""}}}, .Subscribe = {}});
    text.insert(text.find("<allow_rule>"), rules);
    EXPECT_FALSE(ReadPermissions(text, "file").front().MayPublish(7, {"Pose", {""}}));
}

TEST(Permissions, SignsOfXmlInNamesStayNames)
{
    const Access access{.Domain = 0, .Publish = {{"a<b>&c", {""}}}, .Subscribe = {}};
    EXPECT_EQ(ReadBack(access).Rules.at(0).Publish, access.Publish);
}

TEST(Permissions, ManyStarsInAPatternTakeNoTime)
{
    std::string stars;
    for (int i = 0; i < 100; ++i)
    {
        stars += "*a";
    }
    const Permissions read = ReadBack({.Domain = 0, .Publish = {{stars + "b", {""}}}, .Subscribe = {}});
    EXPECT_FALSE(read.MayPublish(0, {std::string(5000, 'a'), {""}}));
}

TEST(Permissions, WhatIsNoneIsOneError)
{
    for (const std::string text :
         {"", "<dds>", "<dds/>", "<dds><permissions/></dds>", "no XML",
          "<dds><permissions><grant><allow_rule><domains><id>x</id></domains></allow_rule></grant>"
          "</permissions></dds>"})
    {
        try
        {
            ReadPermissions(text, "some file");
            ADD_FAILURE() << text;
        }
        catch (const KeysError &error)
        {
            EXPECT_THAT(error.what(), HasSubstr("some file"));
            EXPECT_THAT(error.what(), Not(HasSubstr("\n")));
        }
    }
}

TEST(Permissions, TruncatedOnesAreErrorsOrSayLess)
{
    const std::string whole = PermissionsText(
        Uav1, SomeTime, {.Domain = 7, .Publish = {{"Pose", {"", "uav1"}}}, .Subscribe = {{"Pose", {"*"}}}});
    for (std::size_t size = 0; size + 2 < whole.size(); ++size)
    {
        EXPECT_THROW(ReadPermissions(whole.substr(0, size), "file"), KeysError) << size;
    }
}

}  // namespace
}  // namespace Rabit::Keys
