#include "SafeText.h"

#include <gtest/gtest.h>

namespace Rabit::Tool
{
namespace
{

TEST(SafeText, NoEscapeSequenceGetsThrough)
{
    EXPECT_EQ(SafeText("\x1b[2Juav1\x07\r\n"), "?[2Juav1???");
    EXPECT_EQ(SafeText("\x9b"
                       "31m\xc2\x9b"
                       "31m\x7f"),
              "?31m??31m?");
}

TEST(SafeText, PrintableTextStaysAsItIs)
{
    EXPECT_EQ(SafeText("Uav::Pose {a: [1, 2]} ~"), "Uav::Pose {a: [1, 2]} ~");
}

TEST(SafeText, LinesAndTabsStayInLines)
{
    EXPECT_EQ(SafeLines("struct A {\n\tlong\x1b[0m a;\n};"), "struct A {\n\tlong?[0m a;\n};");
}

}  // namespace
}  // namespace Rabit::Tool
