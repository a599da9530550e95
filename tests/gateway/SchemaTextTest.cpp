// Names that IDL takes for keywords, in texts for readers of other makers.
#include <gtest/gtest.h>
#include <rabit/dynamic/DynamicType.h>
#include <rabit/gateway/SchemaText.h>

namespace Rabit
{
namespace
{

constexpr const char *Escaped =
    "module std_msgs { module msg {\n@final\nstruct _String {\n    string data;\n};\n}; };\n"
    "@final\nstruct Info {\n    std_msgs::msg::_String name;\n    boolean _publishes;\n"
    "    @default(\"an _Any\") string text;\n    @default(TRUE) boolean on;\n};\n";

TEST(SchemaText, NamesThatAreKeywordsInAnotherCaseAreNotEscaped)
{
    EXPECT_EQ(SchemaText(Escaped),
              "module std_msgs { module msg {\n@final\nstruct String {\n    string data;\n};\n}; };\n"
              "@final\nstruct Info {\n    std_msgs::msg::String name;\n    boolean _publishes;\n"
              "    @default(\"an _Any\") string text;\n    @default(TRUE) boolean on;\n};\n")
        << "_publishes is a keyword as it stands";
}

TEST(SchemaText, OtherTextsStay)
{
    for (const std::string text : {"", "_", "// _String\nstruct a_String { long x; };", "/* _Any",
                                   "@default('_') char c; @default(\"\\\"_Any\")"})
    {
        EXPECT_EQ(SchemaText(text), text);
    }
}

TEST(SchemaText, WhatRabitWritesRabitReads)
{
    for (const std::string name : {"std_msgs::msg::String", "Info"})
    {
        const ParsedType escaped = DynamicType::Parse(Escaped, name);
        ASSERT_TRUE(escaped.Type) << escaped.Reason;
        const ParsedType parsed = DynamicType::Parse(SchemaText(Escaped), name);
        ASSERT_TRUE(parsed.Type) << parsed.Reason;
        EXPECT_EQ(parsed.Type->IdlText(), escaped.Type->IdlText()) << "it is one definition";
    }
}

}  // namespace
}  // namespace Rabit
