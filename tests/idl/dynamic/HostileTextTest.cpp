// Texts that no generator wrote: each is refused with its reason, quickly, and none reaches the parser,
// which it could harm.
#include <rabit/dynamic/DynamicType.h>

#include <gtest/gtest.h>

#include <string>
#include <thread>
#include <vector>

namespace Rabit
{
namespace
{

// Returns `S7`. Appends rather than adds: g++ 12 warns wrongly when a string is added to a literal.
std::string Numbered(const char *prefix, int number)
{
    std::string text = prefix;
    text += std::to_string(number);
    return text;
}

std::string WhyNot(const std::string &text, const std::string &name = "S")
{
    const ParsedType parsed = DynamicType::Parse(text, name);
    EXPECT_EQ(parsed.Type == nullptr, !parsed.Reason.empty());
    return parsed.Reason;
}

TEST(HostileText, OfAnotherLanguageIsRefused)
{
    EXPECT_EQ(WhyNot("hello"), "line 1: expected a definition, not 'hello'");
    EXPECT_EQ(WhyNot("#include \"/etc/passwd\"\nstruct S { long a; };"), "line 1: unexpected '#'");
    EXPECT_EQ(WhyNot("const long A = 1 + 1;"), "line 1: unexpected '='");
    EXPECT_EQ(WhyNot("Struct S { long a; };"), "line 1: expected a definition, not 'Struct'");
    EXPECT_EQ(WhyNot("interface I { };"), "line 1: expected a definition, not 'interface'");
    EXPECT_EQ(WhyNot("struct S { long a; }"), "line 1: expected ';', not the end");
    EXPECT_EQ(WhyNot("struct S { wstring a; };"), "line 1: expected a name, not 'wstring'");
    EXPECT_EQ(WhyNot("\nstruct S { @optional long a; };"),
              "line 2: annotation '@optional' is not supported here");
    EXPECT_EQ(WhyNot("struct S { string a; // \x1b[2J\n};"),
              "line 1: a comment has a character that is not supported");
    EXPECT_EQ(WhyNot(std::string("struct S { long a; };\0", 22)),
              "line 1: a character is not printable ASCII");
    EXPECT_EQ(WhyNot("struct S { @unit(\"\xc2\xb0\") long a; };"),
              "line 1: a text or character is not closed, or not printable");
    EXPECT_EQ(WhyNot(""), "the text defines no message 'S'");
}

TEST(HostileText, WithoutTheMessageIsRefused)
{
    EXPECT_EQ(WhyNot("struct T { long a; };"), "the text defines no message 'S'; did you mean `T`?");
    EXPECT_EQ(WhyNot("@nested struct S { long a; };"), "'S' is @nested: no message");
    EXPECT_EQ(WhyNot("enum S { A };"), "the text defines no message 'S'");
}

// The parser takes any name for the annotation's, and crashes if the two differ in case.
TEST(HostileText, WithAnAnnotationBehindANameThatIsTheSameButForItsCaseIsRefused)
{
    const char *const reason = "line 1: annotation '@key' behind a name that differs from it in case alone";
    EXPECT_EQ(WhyNot("module Key { struct S { @key octet a; }; };", "Key::S"), reason);
    EXPECT_EQ(WhyNot("module M { module KEY { struct S { @key octet a; }; }; };", "M::KEY::S"), reason);
    EXPECT_EQ(WhyNot("struct S { octet Key; @key octet a; };"), reason);
    EXPECT_EQ(WhyNot("struct S { octet KEY[2]; @key octet a; };"), reason);
    EXPECT_EQ(WhyNot("enum E { Key }; struct S { @key octet a; };"), reason);
    EXPECT_EQ(WhyNot("bitmask B { Key }; struct S { @key octet a; };"), reason);
    EXPECT_EQ(WhyNot("module Final { @final struct S { octet a; }; };", "Final::S"),
              "line 1: annotation '@final' behind a name that differs from it in case alone");
    EXPECT_EQ(WhyNot("struct S { octet key; @key octet a; octet Id; };"), "");
}

// The parser looks up a name where it means something else first, and does not see that the name is there
// twice.
TEST(HostileText, WithANameTwiceInOnePlaceIsRefused)
{
    EXPECT_EQ(
        WhyNot("module A { struct P { long a; }; }; module A { struct S { A::P A; A::P A; }; };", "A::S"),
        "'A' is there twice");
}

TEST(HostileText, ThatTheParserRefusesIsToldInItsWords)
{
    EXPECT_EQ(WhyNot("struct S { Unknown a; };"), "line 1: Scoped name 'Unknown' cannot be resolved");
    EXPECT_EQ(WhyNot("struct S { string a; };\nenum E { A, A };").substr(0, 7), "line 2:");
}

// The parser writes refused text to the standard error output, where a stranger's text must not appear.
TEST(HostileText, IsNotRepeatedOnTheErrorOutput)
{
    testing::internal::CaptureStderr();
    WhyNot("struct S { Unknown a; };");
    WhyNot("struct S { long a; long a; };");
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(HostileText, ThatTheGeneratorRefusesIsRefusedForTheSameReason)
{
    EXPECT_EQ(WhyNot("struct S { S a; };"),
              "line 1: 'S' is used before its definition is complete (recursive types are not supported)");
    EXPECT_EQ(WhyNot("struct S { @key sequence<long> a; };"),
              "line 1: a key that is or contains a sequence is not supported");
}

TEST(HostileText, AboveALimitIsRefused)
{
    EXPECT_EQ(WhyNot(std::string(200000, ' ')), "the text has more than 131072 bytes");
    EXPECT_EQ(WhyNot("struct " + std::string(129, 'a') + " { long a; };"),
              "line 1: a name has more than 128 letters");
    EXPECT_EQ(WhyNot("struct S { long a[4096][4096]; };"), "an array takes more than 8388608 bytes");
    EXPECT_EQ(WhyNot("struct S { octet a[4294967295][4294967295][4294967295]; };"),
              "an array takes more than 8388608 bytes");
    EXPECT_EQ(WhyNot("struct S { long a[0]; };"), "line 1: expected a number from 1 to 4294967295, not '0'");
    std::string members;
    for (int i = 0; i < 2001; ++i)
    {
        members += Numbered("octet m", i) + ";";
    }
    EXPECT_EQ(WhyNot("struct S {" + members + "};"),
              "line 1: more than 2000 members, cases, values and bits");
    std::string definitions;
    for (int i = 0; i < 1001; ++i)
    {
        definitions += Numbered("typedef long t", i) + ";";
    }
    EXPECT_EQ(WhyNot(definitions), "line 1: more than 1000 definitions");
}

TEST(HostileText, DeeperThanALimitIsRefused)
{
    std::string open;
    std::string close;
    for (int i = 0; i < 40; ++i)
    {
        open += "sequence<";
        close += " >";
    }
    EXPECT_EQ(WhyNot("struct S { " + open + "long" + close + " a; };"),
              "line 1: more than 32 types within each other");
    EXPECT_EQ(WhyNot("struct S { long a" + std::string(40, '[') + "; };").substr(0, 25),
              "line 1: expected a number");
    std::string modules;
    for (int i = 0; i < 40; ++i)
    {
        modules += Numbered("module m", i) + " {";
    }
    EXPECT_EQ(WhyNot(modules), "line 1: more than 32 modules within each other");
    std::string chain = "struct S0 { octet a; };";
    for (int i = 1; i < 100; ++i)
    {
        chain += Numbered("struct S", i) + Numbered(" { S", i - 1) + " a; };";
    }
    EXPECT_EQ(WhyNot(chain, "S99"), "types are nested more than 64 deep");
}

// Each struct holds the one before it several times. Sizes and work that follow every path would double
// with each struct.
TEST(HostileText, ThatDoublesWithEachLineIsRefusedAtOnce)
{
    for (const char *const key : {"", "@key "})
    {
        std::string text = "struct S0 { octet a; };";
        for (int i = 1; i < 60; ++i)
        {
            const std::string before = key + Numbered("S", i - 1);
            text += Numbered("struct S", i) + " { " + before + " a; " + before + " b; };";
        }
        EXPECT_EQ(WhyNot(text, "S59").find("takes more than 8388608 bytes") != std::string::npos, true)
            << key;
    }
}

// idlc 0.10.2 crashes on these texts.
TEST(HostileText, WithAnAnnotationBehindATypeOfItsNameIsRefused)
{
    EXPECT_EQ(WhyNot("module M { union Value switch (long) { case 1: long a; }; enum E { @value(1) A }; };"),
              "line 1: annotation '@value' behind a type of that name");
    EXPECT_EQ(WhyNot("struct key { long a; }; module M { struct S { @key long b; }; };", "M::S"),
              "line 1: annotation '@key' behind a type of that name");
    EXPECT_EQ(
        WhyNot("module L { struct key { long a; }; }; module M { struct S { @key long b; }; };", "M::S"), "");
    EXPECT_EQ(WhyNot("struct Other { long key; long value; }; struct S { @key long b; };"), "");
}

TEST(HostileText, NearALimitIsReadInReasonableTime)
{
    std::string members;
    for (int i = 0; i < 1950; ++i)
    {
        members += Numbered("@key octet member", i) + ";";
    }
    EXPECT_EQ(WhyNot("struct S {" + members + "};"), "");
    std::string values;
    for (int i = 0; i < 1950; ++i)
    {
        values += (i == 0 ? "V" : ",V") + std::to_string(i);
    }
    EXPECT_EQ(WhyNot("enum E {" + values + "}; struct S { E e; };"), "");
    std::string cases;
    for (int i = 0; i < 950; ++i)
    {
        cases += Numbered("case ", i) + Numbered(": octet c", i) + ";";
    }
    EXPECT_EQ(WhyNot("union U switch (long) {" + cases + "}; struct S { U u; };"), "");
    std::string chain = "@nested struct S0 { octet m0; };";
    for (int i = 1; i < 990; ++i)
    {
        const std::string number = std::to_string(i);
        chain += "@nested struct S" + number + Numbered(" : S", i - 1) + " { octet m" + number + "; };";
    }
    EXPECT_EQ(WhyNot(chain + "struct S : S989 { octet m; };"), "");
}

TEST(HostileText, MayComeToSeveralThreadsAtOnce)
{
    std::vector<std::thread> threads;
    for (int i = 0; i < 4; ++i)
    {
        threads.emplace_back(
            []
            {
                for (int round = 0; round < 50; ++round)
                {
                    EXPECT_TRUE(DynamicType::Parse("struct S { @default(3) long a; };", "S").Type);
                    EXPECT_EQ(WhyNot("struct S { Unknown a; };"),
                              "line 1: Scoped name 'Unknown' cannot be resolved");
                }
            });
    }
    for (std::thread &thread : threads)
    {
        thread.join();
    }
}

}  // namespace
}  // namespace Rabit
