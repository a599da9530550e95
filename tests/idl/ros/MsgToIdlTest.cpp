// `.msg` files to IDL, and the files that are refused.
#include <gtest/gtest.h>

#include "ros/MsgReader.h"
#include "ros/MsgToIdl.h"

namespace
{

std::string IdlOf(const std::string &msg)
{
    RabitIdl::Refusals refusals;
    const RabitIdl::MsgFile file = RabitIdl::MsgReader("Thing.msg", refusals).Read(msg, "pkg", "Thing");
    return refusals.Empty() ? RabitIdl::MsgToIdl(file) : "refused: " + refusals.First();
}

// Returns the contents of the struct.
std::string Members(const std::string &msg)
{
    const std::string idl = IdlOf(msg);
    const std::string begin = "struct Thing {\n";
    const std::size_t at = idl.find(begin);
    return at == std::string::npos
               ? idl
               : idl.substr(at + begin.size(), idl.rfind("};\n};\n};\n") - at - begin.size());
}

TEST(MsgToIdl, IsAStructInTheModulesOfItsPackage)
{
    EXPECT_EQ(IdlOf("int32 sec\n"),
              "// Made from pkg/msg/Thing.msg. Do not edit.\nmodule pkg {\nmodule msg {\n\n@final\n"
              "struct Thing {\n    int32 sec;\n};\n};\n};\n");
}

TEST(MsgToIdl, HasTheTypesThatRosMeans)
{
    EXPECT_EQ(Members("bool a\nbyte b\nchar c\nfloat32 d\nfloat64 e\nstring f\nint64 g"),
              "    boolean a;\n    octet b;\n    uint8 c;\n    float d;\n    double e;\n    string f;\n    "
              "int64 g;\n");
}

TEST(MsgToIdl, HasBoundsAndArrays)
{
    EXPECT_EQ(Members("string<=4 a\nstring<=4[] b\nstring[<=3] c\nuint8[7] d\nuint8[] e\nstring<=4[<=2] f"),
              "    string<4> a;\n    sequence<string<4> > b;\n    sequence<string, 3> c;\n    uint8 d[7];\n"
              "    sequence<uint8> e;\n    sequence<string<4>, 2> f;\n");
}

TEST(MsgToIdl, IncludesTheMessagesThatItIsMadeOf)
{
    const std::string idl = IdlOf("Part[2] a\nother/Thing b\nother/msg/Thing c\nother/String[] d");
    EXPECT_NE(idl.find("#include \"other/msg/String.idl\"\n#include \"other/msg/Thing.idl\"\n"
                       "#include \"pkg/msg/Part.idl\"\nmodule"),
              std::string::npos)
        << idl;
    EXPECT_NE(idl.find("    pkg::msg::Part a[2];\n    other::msg::Thing b;\n    other::msg::Thing c;\n"
                       "    sequence<other::msg::_String> d;\n"),
              std::string::npos)
        << idl;
}

TEST(MsgToIdl, WritesNamesThatAreKeywordsOfIdlWithAnUnderscore)
{
    EXPECT_EQ(Members("uint8 map\nuint8 Any"), "    uint8 _map;\n    uint8 _Any;\n");
}

TEST(MsgToIdl, HasAMemberIfThereIsNoField)
{
    EXPECT_EQ(Members("# nothing\n"), "    uint8 structure_needs_at_least_one_member;\n");
}

TEST(MsgToIdl, KeepsCommentsWithWhatTheyAreAbout)
{
    EXPECT_EQ(Members("int8 a # of a \\\n       # and more\n# of b\nint8 b\n"),
              "    // of a\n    // and more\n    int8 a;\n    // of b\n    int8 b;\n");
    EXPECT_NE(IdlOf("# of all\n\nint8 a").find("// of all\n@final"), std::string::npos);
}

TEST(MsgToIdl, TakesAHashWithinQuotesForText)
{
    EXPECT_EQ(Members("string a \"#1\" # one\nstring b don't # two"),
              "    // one\n    @default (value=\"#1\") string a;\n    // two\n    @default (value=\"don't\") "
              "string b;\n");
}

TEST(MsgToIdl, NeedsNoBlanksAroundAConstant)
{
    EXPECT_NE(IdlOf("uint16 A=400# there").find("    // there\n    const uint16 A = 400;\n"),
              std::string::npos);
}

TEST(MsgToIdl, TakesTrueAndFalseInAnyCase)
{
    EXPECT_NE(IdlOf("bool X=TRUE").find("    const boolean X = TRUE;\n"), std::string::npos);
    EXPECT_EQ(Members("bool a FALSE\nbool b tRUE"),
              "    @default (value=FALSE) boolean a;\n    @default (value=TRUE) boolean b;\n");
}

TEST(MsgToIdl, TakesADefaultWithAnEqualSignForADefault)
{
    EXPECT_EQ(Members("string a \"x=1\""), "    @default (value=\"x=1\") string a;\n");
}

struct Bad
{
    const char *Msg;
    const char *Refusal;
};

class MsgRefusal : public testing::TestWithParam<Bad>
{
};

TEST_P(MsgRefusal, SaysWhereAndWhy)
{
    EXPECT_EQ(IdlOf(std::string("\n") + GetParam().Msg),
              std::string("refused: Thing.msg:2: ") + GetParam().Refusal);
}

INSTANTIATE_TEST_SUITE_P(
    Files, MsgRefusal,
    testing::Values(
        Bad{"wstring a", "type wstring is not supported: ROS 2's implementations do not agree on its bytes"},
        Bad{"time a", "type time is of ROS 1; expected builtin_interfaces/Time"},
        Bad{"int8[] a [1, 2]", "a default of an array is not supported"},
        Bad{"Part a 1", "a default of a message is not supported"},
        Bad{"uint8 a 256", "`256` is no value of uint8"}, Bad{"int8 A=-129", "`-129` is no value of int8"},
        Bad{"float32 a nan", "`nan` is no value of float that IDL can write"},
        Bad{"float32 A=1e39", "`1e39` is no value of float that IDL can write"},
        Bad{"bool a yes", "`yes` is no value of bool; expected true or false"},
        Bad{"string<=2 a abc", "the default is longer than its bound"},
        Bad{"int8[0] a", "`0` is no length of an array; expected 1 to 4294967295"},
        Bad{"int8[2 a", "expected `]` at the end of `int8[2`"}, Bad{"int7 a", "`int7` is no type"},
        Bad{"int8<=3 a", "`int8<=3` is no type"}, Bad{"pkg/srv/Thing a", "`pkg/srv/Thing` is no type"},
        Bad{"int8", "expected a type and a name, found `int8`"}, Bad{"int8 1a", "`1a` is no name of a field"},
        Bad{"int8 default", "'default' is a keyword of C++"},
        Bad{"uint8 EINVAL = 1", "'EINVAL' is a macro of the headers that generated code includes"},
        Bad{"Part A = 1", "a constant cannot be of this type"}));

TEST(MsgToIdl, RefusesANameThatIsThereTwice)
{
    EXPECT_EQ(IdlOf("int8 a\nint8 a"), "refused: Thing.msg:2: 'a' is there twice");
}

}  // namespace
