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

// IDL keywords are keywords in upper and lower case.
TEST(RosIdlText, EscapesNamesThatAreKeywordsInAnotherCase)
{
    EXPECT_EQ(RosIdlText("struct Char {\n  const uint8 INT8 = 1;\n  a::msg::Object o;\n};\n"),
              "struct _Char {\n  const uint8 _INT8 = 1;\n  a::msg::_Object o;\n};\n");
}

TEST(RosIdlText, EscapesMembersAndConstantsThatAreKeywords)
{
    EXPECT_EQ(RosIdlText("uint8 default;\nsequence<char, 3> map ;\nlong in[3];\nconst long case = 1;\n"),
              "uint8 _default;\nsequence<char, 3> _map ;\nlong _in[3];\nconst long _case = 1;\n");
}

TEST(RosIdlText, LeavesKeywordsThatAreMeant)
{
    for (const std::string text :
         {"unsigned long x;\n", "@default (value=TRUE)\n", "const boolean B = FALSE;\n",
          "const string S = \"Char\"; // Char\n", "sequence<string> a;\n", "typedef char Letters[2];\n",
          "@default (value=1)\nlong value;\n"})
    {
        EXPECT_EQ(RosIdlText(text).find('_'), text.find('_')) << RosIdlText(text);
    }
}

TEST(RosIdlText, EndsWhateverIsNotClosed)
{
    EXPECT_EQ(RosIdlText("@verbatim (\"a\n"), "\n");
    EXPECT_EQ(RosIdlText("/* a"), "/* a\n");
    EXPECT_EQ(RosIdlText("\"a\\"), "\"a\\\n");
}

}  // namespace
