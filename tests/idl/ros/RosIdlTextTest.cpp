// IDL as rosidl makes it, for idlc.
#include <gtest/gtest.h>

#include "ros/RosIdlText.h"

namespace
{

using RabitIdl::RosIdlText;

TEST(RosIdlText, DefinesATypedefOfAnArrayOnce)
{
    EXPECT_EQ(RosIdlText("module a {\n  module msg {\n    typedef double double__3[3];\n  };\n};\n"),
              "module a {\n  module msg {\n#ifndef RABIT_TYPEDEF_a_msg_double__3\n#define "
              "RABIT_TYPEDEF_a_msg_double__3\n"
              "    typedef double double__3[3];\n#endif\n  };\n};\n");
}

TEST(RosIdlText, KnowsTheModuleAfterAStructHasEnded)
{
    const std::string text =
        RosIdlText("module a {\nstruct S {\n};\nmodule C {\n};\ntypedef b__c b__c__2[2];\n};\n");
    EXPECT_NE(text.find("RABIT_TYPEDEF_a_b__c__2\n"), std::string::npos) << text;
}

TEST(RosIdlText, LeavesOtherTypedefsAlone)
{
    EXPECT_EQ(RosIdlText("typedef long Count;\n"), "typedef long Count;\n");
}

TEST(RosIdlText, PartsWhatEndsTwoSequences)
{
    EXPECT_EQ(RosIdlText("sequence<sequence<string<4>>> a; // >>\n"),
              "sequence<sequence<string<4> > > a; // >>\n");
}

TEST(RosIdlText, LeavesOutVerbatimAndKeepsTheLines)
{
    EXPECT_EQ(
        RosIdlText("@verbatim (language=\"comment\", text=\n  \"a ) \\\" b\" \"\\n\"\n  \"(c\")\nlong a;\n"),
        "\n\n\nlong a;\n");
}

TEST(RosIdlText, EndsWhateverIsNotClosed)
{
    EXPECT_EQ(RosIdlText("@verbatim (\"a\n"), "\n");
    EXPECT_EQ(RosIdlText("/* a"), "/* a\n");
    EXPECT_EQ(RosIdlText("\"a\\"), "\"a\\\n");
}

}  // namespace
