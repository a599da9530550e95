#include <rabit/idl/NearestWord.h>

#include <gtest/gtest.h>

namespace Rabit
{
namespace
{

TEST(NearestWord, NamesTheWordOneSlipAway)
{
    EXPECT_EQ(NearestWordHint("publsh", {"publish", "subscribe"}), "; did you mean `publish`?");
    EXPECT_EQ(NearestWordHint("uav::pose", {"Uav::Goto", "Uav::Pose"}), "; did you mean `Uav::Pose`?");
}

TEST(NearestWord, ListsWhatIsExpectedWhenNothingIsNear)
{
    EXPECT_EQ(NearestWordHint("zzzzzz", {"on", "off"}), "; expected one of `on`, `off`");
    EXPECT_EQ(NearestWordHint("zzzzzz", {"fastdds"}), "; expected `fastdds`");
    EXPECT_EQ(NearestWordHint("zzzzzz", {}), "");
}

}  // namespace
}  // namespace Rabit
