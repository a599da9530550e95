#include "presence/OtherFormats.h"

#include <gtest/gtest.h>

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;

TEST(OtherFormats, NamesANodeAsLongAsItIsHeard)
{
    OtherFormats formats;
    formats.Heard("uav1", 1s);
    const auto problems = formats.Problems(5s);
    ASSERT_EQ(problems.size(), 1u);
    EXPECT_EQ(problems[0].subject, "node uav1");
    EXPECT_EQ(problems[0].node, "uav1");
    EXPECT_EQ(
        problems[0].reason,
        "its gateway speaks another version of presence than this one: neither knows what the other has");
    EXPECT_TRUE(formats.Problems(1s + OtherFormats::Memory).empty());
}

TEST(OtherFormats, RemembersABoundedNumber)
{
    OtherFormats formats;
    for (int i = 0; i < 1000; ++i)
    {
        formats.Heard(std::string("n").append(std::to_string(i)), 1s);
    }
    EXPECT_EQ(formats.Problems(1s).size(), OtherFormats::MostRemembered);
    formats.Heard("late", 60s);
    EXPECT_EQ(formats.Problems(60s).size(), 1u);
}

}  // namespace
}  // namespace Rabit
