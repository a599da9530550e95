// JSON as a person expects it, and the reasons for which other JSON is refused.
#include <rabit/dynamic/DynamicType.h>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace Rabit
{
namespace
{

constexpr const char *Text = R"(module Test {
enum Kind { NONE, @value(7) @default_literal SEVEN, LAST };
@bit_bound(8) bitmask Lamps { RED, @position(7) STROBE };
@final @nested struct Point { double x; @default(1.5) double y; };
@final union Choice switch (long) {
case 1: case 2: long number;
case 3: string<4> word;
default: Test::Point point;
};
@final union Perhaps switch (boolean) { case TRUE: octet present; };
@final struct All {
    boolean flag;
    char letter;
    octet raw;
    int8 tiny;
    unsigned long long big;
    long long low;
    float real;
    double precise;
    string<8> word;
    Test::Kind kind;
    Test::Lamps lamps;
    sequence<octet, 3> blob;
    octet three[3];
    short grid[2][2];
    sequence<Test::Point, 2> points;
    Test::Choice choice;
    Test::Perhaps perhaps;
};
};
)";

const DynamicType &All()
{
    static const auto type = DynamicType::Parse(Text, "Test::All").Type;
    return *type;
}

// Returns the member's value as JSON, after it was decoded from `json`.
std::string Through(const std::string &member, const std::string &json)
{
    const EncodedSample encoded = All().FromJson("{\"" + member + "\":" + json + "}");
    if (!encoded.Sample)
    {
        return encoded.Reason;
    }
    return nlohmann::ordered_json::parse(All().ToJson(*encoded.Sample).value())[member].dump();
}

TEST(Json, CanHaveAllIntegersOf64BitsAsText)
{
    const auto type = DynamicType::Parse(
        "@final union Label switch (long long) { case 1: long small; };"
        "@final union Narrow switch (long) { case -1: long small; };"
        "@final struct Wide { unsigned long long big; sequence<long long> low; unsigned long narrow; double "
        "real;"
        " Label label; Narrow other; };",
        "Wide");
    ASSERT_TRUE(type.Type) << type.Reason;
    const std::string json =
        R"({"big":"1","low":["-9007199254740993"],"narrow":4294967295,"real":1,"label":{"_d":"7"},"other":{"_d":-7}})";
    const auto sample = type.Type->FromJson(json).Sample;
    ASSERT_TRUE(sample) << type.Type->FromJson(json).Reason;
    EXPECT_EQ(type.Type->ToJson(*sample, DynamicType::Wide::Text), json);
    EXPECT_EQ(
        type.Type->ToJson(*sample),
        R"({"big":1,"low":[-9007199254740993],"narrow":4294967295,"real":1,"label":{"_d":7},"other":{"_d":-7}})");
}

TEST(Json, OfANewMessageHasEveryMember)
{
    EXPECT_EQ(
        All().ToJson(All().DefaultSample()),
        R"({"flag":false,"letter":"\u0000","raw":0,"tiny":0,"big":0,"low":0,"real":0,"precise":0,)"
        R"("word":"","kind":"SEVEN","lamps":[],"blob":"","three":"AAAA","grid":[[0,0],[0,0]],"points":[],)"
        R"("choice":{"number":0},"perhaps":{"present":0}})");
}

TEST(Json, LeavesDefaultsToWhatItDoesNotName)
{
    EXPECT_EQ(All().FromJson("{}").Sample, All().DefaultSample());
    EXPECT_EQ(Through("points", R"([{"x":3},{}])"), R"([{"x":3,"y":1.5},{"x":0,"y":1.5}])");
    EXPECT_EQ(Through("choice", "{}"), R"({"number":0})");
    EXPECT_EQ(Through("choice", R"({"point":{}})"), R"({"point":{"x":0,"y":1.5}})");
}

TEST(Json, KeepsIntegersOf64Bits)
{
    EXPECT_EQ(Through("big", "18446744073709551615"), "18446744073709551615");
    EXPECT_EQ(Through("low", "-9223372036854775808"), "-9223372036854775808");
    EXPECT_EQ(Through("big", "\"18446744073709551615\""), "18446744073709551615");
    EXPECT_EQ(Through("low", "\"-9223372036854775808\""), "-9223372036854775808");
    EXPECT_EQ(Through("tiny", "\"-5\""), "-5");
    EXPECT_EQ(Through("low", "1e3"), "1000") << "a whole number, however it is written";
}

TEST(Json, NamesWhatIsNoNumber)
{
    EXPECT_EQ(Through("real", "\"NaN\""), "\"NaN\"");
    EXPECT_EQ(Through("precise", "\"Infinity\""), "\"Infinity\"");
    EXPECT_EQ(Through("real", "\"-Infinity\""), "\"-Infinity\"");
    EXPECT_EQ(Through("precise", "-0.0"), "-0.0");
}

TEST(Json, WritesOctetsAsBase64AndReadsThemAsAListToo)
{
    EXPECT_EQ(Through("blob", "\"/wA=\""), "\"/wA=\"");
    EXPECT_EQ(Through("blob", "[255, 0]"), "\"/wA=\"");
    EXPECT_EQ(Through("three", "\"AQID\""), "\"AQID\"");
}

TEST(Json, WritesBitsAsAList)
{
    EXPECT_EQ(Through("lamps", R"(["STROBE","RED"])"), R"(["RED","STROBE"])");
}

TEST(Json, TellsTheDiscriminatorWhereTheCaseDoesNot)
{
    EXPECT_EQ(Through("choice", R"({"number":5})"), R"({"number":5})");
    EXPECT_EQ(Through("choice", R"({"_d":2,"number":5})"), R"({"_d":2,"number":5})");
    EXPECT_EQ(Through("choice", R"({"_d":3})"), R"({"word":""})");
    EXPECT_EQ(Through("perhaps", R"({"_d":false})"), R"({"_d":false})");
}

TEST(Json, HoldsTextsAsTheyAre)
{
    EXPECT_EQ(Through("word", R"("gr\u00fc\u00df")"), "\"gr\xc3\xbc\xc3\x9f\"");
    EXPECT_EQ(Through("letter", R"("\u00ff")"), "\"\xc3\xbf\"");
    EXPECT_EQ(Through("word", R"({"base64":"/w=="})"), R"({"base64":"/w=="})") << "not UTF-8";
}

TEST(Json, LetsNoControlCharacterThrough)
{
    const EncodedSample encoded = All().FromJson(R"({"word": "\u001b[2J\u009b\u007f"})");
    ASSERT_TRUE(encoded.Sample) << encoded.Reason;
    EXPECT_NE(All().ToJson(*encoded.Sample)->find(R"("word":"\u001b[2J\u009b\u007f")"), std::string::npos);
}

TEST(Json, OfFloatsIsTheShortestThatGivesTheSameBack)
{
    EXPECT_EQ(Through("real", "0.1"), "0.1");
    EXPECT_EQ(Through("real", "16777217"), "16777216");
    const EncodedSample sample = All().FromJson(R"({"real": 7.038530691851209e-26})");
    ASSERT_TRUE(sample.Sample);
    EXPECT_EQ(All().FromJson(All().ToJson(*sample.Sample).value()).Sample, sample.Sample)
        << "7.0385307e-26 as a double is halfway to the next float";
}

TEST(Json, ThatDoesNotFitIsToldByItsPath)
{
    EXPECT_EQ(Through("flag", "1"), "flag: expected true or false, not 1");
    EXPECT_EQ(Through("raw", "256"), "raw: expected a whole number from 0 to 255, not 256");
    EXPECT_EQ(Through("tiny", "-129"), "tiny: expected a whole number from -128 to 127, not -129");
    EXPECT_EQ(Through("tiny", "1.5"), "tiny: expected a whole number from -128 to 127, not 1.5");
    for (const char *text :
         {"\"\"", "\"1e3\"", "\"0x10\"", "\" 1\"", "\"1 \"", "\"18446744073709551616\"", "\"--1\""})
    {
        EXPECT_EQ(Through("big", text),
                  std::string("big: expected a whole number from 0 to 18446744073709551615, not ") + text);
    }
    EXPECT_EQ(Through("big", "-1"), "big: expected a whole number from 0 to 18446744073709551615, not -1");
    EXPECT_EQ(Through("low", "9223372036854775808"),
              "low: expected a whole number from -9223372036854775808 to 9223372036854775807, not "
              "9223372036854775808");
    EXPECT_EQ(Through("real", "1e39"),
              "real: expected a number that a float can hold, up to 3.4028235e+38, not 1e+39");
    EXPECT_EQ(Through("real", "null"),
              "real: expected a number, \"NaN\", \"Infinity\" or \"-Infinity\", not null");
    EXPECT_EQ(Through("letter", "\"ab\""),
              "letter: expected a text of one character, U+0000 to U+00FF, not \"ab\"");
    EXPECT_EQ(Through("word", "\"123456789\""), "word: expected at most 8 bytes, not 9");
    EXPECT_EQ(Through("word", "\"\\u0000\""), "word: expected a text without the character U+0000");
    EXPECT_EQ(Through("blob", "\"AAAAAA==\""), "blob: expected at most 3 octets, not 4");
    EXPECT_EQ(Through("blob", "\"A\""), "blob: expected base64, padded with =, not \"A\"");
    EXPECT_EQ(Through("three", "[1]"), "three: expected 3 elements, not 1");
    EXPECT_EQ(Through("grid", "[[1,2],[3,true]]"),
              "grid[1][1]: expected a whole number from -32768 to 32767, not true");
    EXPECT_EQ(Through("points", "[{},{},{}]"), "points: expected at most 2 elements, not 3");
    EXPECT_EQ(Through("points", R"([{},{"y":"up"}])"),
              "points[1].y: expected a number, \"NaN\", \"Infinity\" or \"-Infinity\", not \"up\"");
    EXPECT_EQ(Through("points", "{}"), "points: expected a list, not an object");
    EXPECT_EQ(Through("choice", R"({"number":1,"word":""})"),
              "choice: expected one case, not both `number` and `word`");
    EXPECT_EQ(Through("choice", R"({"_d":3,"number":1})"),
              "choice._d: expected a discriminator that selects `number`, not 3");
    EXPECT_EQ(All().FromJson("7").Reason, "expected an object, not 7");
}

TEST(Json, OfAnUnknownNameIsToldTheNearest)
{
    EXPECT_EQ(All().FromJson(R"({"flg": true})").Reason,
              "no member of Test::All is named `flg`; did you mean `flag`?");
    EXPECT_EQ(Through("kind", "\"SEVN\""),
              "kind: no value of Test::Kind is named `SEVN`; did you mean `SEVEN`?");
    EXPECT_EQ(Through("lamps", "[\"BLUE\"]"),
              "lamps[0]: no bit of Test::Lamps is named `BLUE`; expected one of `RED`, `STROBE`");
    EXPECT_EQ(Through("choice", R"({"wird":""})"),
              "choice: no case of Test::Choice is named `wird`; did you mean `word`?");
    EXPECT_EQ(Through("points", R"([{"z":1}])"),
              "points[0]: no member of Test::Point is named `z`; did you mean `x`?");
}

TEST(Json, ThatIsNoneIsToldWhere)
{
    EXPECT_EQ(All().FromJson("{").Reason.substr(0, 36), "not JSON: parse error at line 1, col");
    EXPECT_EQ(All().FromJson(R"({"flag": true, "flag": false})").Reason, "an object names a member twice");
    EXPECT_EQ(All().FromJson(std::string(1000000, '[')).Sample, std::nullopt);
}

// The reason that a person sees must not contain the hostile text.
TEST(Json, ThatIsHostileIsNotRepeatedToATerminal)
{
    for (const char *json : {R"({"\u001b[2J": 1})", R"({"kind": "\u001b[2J\u009b"})", "{\"a\": \x1b}",
                             "{\"\xff\": 1}", R"({"kind": ["\u001b"]})"})
    {
        const std::string reason = All().FromJson(json).Reason;
        ASSERT_FALSE(reason.empty()) << json;
        EXPECT_EQ(reason.find('\x1b'), std::string::npos) << reason;
        EXPECT_EQ(reason.find("\xc2\x9b"), std::string::npos) << reason;
        EXPECT_EQ(reason.find('\n'), std::string::npos) << reason;
    }
}

TEST(Json, OfASampleThatWouldGrowBeyondReasonIsRefused)
{
    const std::string name(100, 'n');
    const auto type = DynamicType::Parse("enum E { " + name +
                                             " }; typedef sequence<sequence<octet> > Rows; struct S { "
                                             "sequence<E> list; Rows rows; };",
                                         "S")
                          .Type;
    ASSERT_TRUE(type);
    nlohmann::ordered_json few;
    few["list"] = std::vector<std::string>(100, name);
    const auto sample = type->FromJsonValue(few).Sample;
    ASSERT_TRUE(sample);
    EXPECT_TRUE(type->ToJson(*sample)) << "4 bytes each";

    const auto wide = DynamicType::Parse("@bit_bound(8) enum E { " + name + "a, " + name +
                                             "b }; @bit_bound(8) bitmask M { " + name + "c, " + name + "d, " +
                                             name + "e }; struct S { sequence<M> list; };",
                                         "S");
    ASSERT_TRUE(wide.Type) << wide.Reason;
    std::vector<std::uint8_t> many{0, 1, 0, 0, 0, 0, 1, 0};  // 65536 bytes of 310 letters each
    many.resize(8 + 65536, 7);
    EXPECT_EQ(wide.Type->ToJson(many), std::nullopt);
    EXPECT_TRUE(wide.Type->Normalized(many)) << "the sample itself is one";
}

}  // namespace
}  // namespace Rabit
