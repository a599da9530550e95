#include "keys/KeysCheck.h"

#include <gmock/gmock.h>

#include "KeysFolder.h"

namespace Rabit::Keys
{
namespace
{

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class KeysCheckTest : public KeysFolder
{
protected:
    KeysCheckTest() { Add("uav1"); }
    NodeKeys Node() const { return NodeKeys(FolderOf("uav1")); }
    // Returns the findings on permissions that a person has changed and signed.
    std::vector<std::string> TooMuchAfter(const std::string &old, const std::string &now)
    {
        Rewrite(NodeFiles(FolderOf("uav1")).Permissions, old, now);
        return Texts(WhatIsTooMuch(Node()));
    }
    static std::vector<std::string> Texts(const std::vector<KeysFinding> &findings)
    {
        std::vector<std::string> texts;
        for (const KeysFinding &finding : findings)
        {
            texts.push_back(finding.Text);
        }
        return texts;
    }
};

TEST_F(KeysCheckTest, FreshOnesAllowNothingTooMuch)
{
    EXPECT_THAT(Texts(WhatIsTooMuch(Node())), IsEmpty());
}

TEST_F(KeysCheckTest, WritingTopicsByAPatternIsTooMuch)
{
    EXPECT_THAT(TooMuchAfter("<topic>Pose</topic></topics><partitions><partition></partition>",
                             "<topic>*</topic></topics><partitions><partition></partition>"),
                ElementsAre(HasSubstr("may write topics by the pattern `*`")));
}

TEST_F(KeysCheckTest, WritingInPartitionsByAPatternIsTooMuch)
{
    EXPECT_THAT(TooMuchAfter("<partition>uav1</partition>", "<partition>uav*</partition>"),
                ElementsAre(HasSubstr("in another node's name")));
}

TEST_F(KeysCheckTest, WritingInThePartitionOfAnotherNodeIsTooMuch)
{
    EXPECT_THAT(TooMuchAfter("<partition>uav1</partition>", "<partition>uav2</partition>"),
                ElementsAre(HasSubstr("in the partition `uav2`, which is of another node")));
}

TEST_F(KeysCheckTest, ReadingTopicsByAPatternIsTooMuch)
{
    EXPECT_THAT(TooMuchAfter("<topic>Pose</topic></topics><partitions><partition>uav*",
                             "<topic>P*</topic></topics><partitions><partition>uav*"),
                ElementsAre(HasSubstr("may read topics by the pattern `P*`")));
}

TEST_F(KeysCheckTest, AllowingWhatIsNotForbiddenIsTooMuch)
{
    EXPECT_THAT(TooMuchAfter("<default>DENY", "<default>ALLOW"),
                ElementsAre(HasSubstr("whatever is not forbidden")));
}

TEST_F(KeysCheckTest, ARangeOfDomainsIsTooMuch)
{
    EXPECT_THAT(TooMuchAfter("<id>7</id>", "<id_range><min>0</min><max>230</max></id_range>"),
                ElementsAre(HasSubstr("a range of domains")));
}

TEST_F(KeysCheckTest, AToolMayReadEverything)
{
    FleetKeys(Place()).Add(
        {.Node = "laptop", .SmallGuid = false, .Access = {7, {{"rabit/Beat", {""}}}, {{"*", {"", "*"}}}}},
        {TestNow, 10});
    EXPECT_THAT(Texts(WhatIsTooMuch(NodeKeys(FolderOf("laptop")))), IsEmpty());
}

TEST_F(KeysCheckTest, ThatTheyEndIsSaidAhead)
{
    EXPECT_THAT(Texts(WhatEnds(Node(), TestNow, 30)), IsEmpty());
    EXPECT_THAT(Texts(WhatEnds(Node(), TestNow + 336 * TestDay, 30)),
                ElementsAre("ends on 2027-11-23, in 29 days; renew it"));
    EXPECT_THAT(Texts(WhatEnds(Node(), TestNow + 366 * TestDay, 30)),
                ElementsAre("ended on 2027-11-23; renew it"));
}

TEST_F(KeysCheckTest, ThatTheyHaveNotBegunIsSaid)
{
    EXPECT_THAT(Texts(WhatEnds(Node(), 0, 30)), ElementsAre(HasSubstr("begins on 2026-11-22"),
                                                            HasSubstr("revoked.pem begins on 2026-11-22")));
}

TEST_F(KeysCheckTest, ThatTheListOfRevokedOnesHasNotBegunIsSaid)
{
    Relist(FolderOf("uav1"), Place(), "identity", {.From = TestNow + 600, .To = TestNow + 3650 * TestDay});
    EXPECT_THAT(Texts(WhatEnds(Node(), TestNow, 30)),
                ElementsAre("revoked.pem begins on 2026-11-23 12:10 UTC, and the clock here says 2026-11-23 "
                            "12:00 UTC"));
}

TEST_F(KeysCheckTest, ThatTheListOfRevokedOnesEndsIsSaidAhead)
{
    Relist(FolderOf("uav1"), Place(), "identity", {.From = TestNow - TestDay, .To = TestNow + 10 * TestDay});
    EXPECT_THAT(Texts(WhatEnds(Node(), TestNow, 30)),
                ElementsAre("revoked.pem ends on 2026-12-03, in 10 days; copy the fleet's present one"));
    EXPECT_THAT(Texts(WhatEnds(Node(), TestNow + 11 * TestDay, 30)),
                ElementsAre("revoked.pem ended on 2026-12-03; copy the fleet's present one"));
}

TEST_F(KeysCheckTest, WhoMayWhatIsSaidInWords)
{
    EXPECT_THAT(WhoMayWhat(Node()), ElementsAre("in domain 7", "writes rabit/Link", "writes Pose",
                                                "reads rabit/Link", "reads Pose of uav*"));
}

}  // namespace
}  // namespace Rabit::Keys
