#include "WrappedLines.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace
{
using Ground::WrappedLines;
using testing::ElementsAre;
using testing::IsEmpty;

TEST(WrappedLines, AreNoneWithoutParts)
{
    EXPECT_THAT(WrappedLines("Head:", {}, 80), IsEmpty());
}

TEST(WrappedLines, AreOneIfThereIsRoom)
{
    EXPECT_THAT(WrappedLines("Head:", {"one", "two"}, 14), ElementsAre("Head: one, two"));
}

TEST(WrappedLines, GoOnIndentedWhereTheColumnsEnd)
{
    EXPECT_THAT(WrappedLines("Head:", {"one", "two", "three"}, 13),
                ElementsAre("Head: one,", "    two,", "    three"));
}

TEST(WrappedLines, CutNoPart)
{
    EXPECT_THAT(WrappedLines("Head:", {"a very long part", "two"}, 5),
                ElementsAre("Head: a very long part,", "    two"));
}

}  // namespace
