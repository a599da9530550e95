// The comments of a generated header, which are for people.
#include "RunIdlc.h"

#include <gtest/gtest.h>

#include <string>

namespace
{

class GeneratedHeader : public testing::Test
{
protected:
    GeneratedHeader()
    {
        const ScratchDirectory scratch;
        const IdlcResult result =
            RunIdlc(std::filesystem::path(Paths::Messages) / "conveniences.idl", scratch.Path());
        EXPECT_EQ(result.ExitCode, 0) << result.Errors;
        _text = ReadFile(scratch.Path() / "conveniences.idl.h");
    }
    bool Has(const std::string &text) const { return _text.find(text) != std::string::npos; }

private:
    std::string _text;
};

TEST_F(GeneratedHeader, SaysOfTypesWhatTheIdlSays)
{
    EXPECT_TRUE(Has("// A motor and what is known of it.\n//\n// It has a gear.\nclass Motor"));
    EXPECT_TRUE(Has("// How the motor runs.\nenum class Gear"));
    EXPECT_TRUE(Has("// One of two.\n"));
    EXPECT_FALSE(Has("// Of the module"));
}

TEST_F(GeneratedHeader, SaysOfMembersWhatTheIdlSaysAndTheirUnit)
{
    EXPECT_TRUE(Has("    // Since it was started.\n    // Unit: rad/s\n    double speed = 0.0;\n"));
    EXPECT_TRUE(Has("    // Many words.\n    // Selected by 1"));
}

TEST_F(GeneratedHeader, TakesNoCommentOfAnAnnotatedMemberForTheNextMember)
{
    EXPECT_TRUE(Has("    double speed = 0.0;\n    // of turns\n"));
}

TEST_F(GeneratedHeader, KeepsTheLinesOfACommentBehindAMemberTogether)
{
    EXPECT_TRUE(Has("    // as painted on it,\n    // in capitals\n    ::std::string name;\n"));
    EXPECT_TRUE(Has("name_bound = 8;\n    ::std::vector<::std::int32_t> history;\n"));
    EXPECT_TRUE(Has("    // glued\n    // on\n    ::Conveniences::Tag tag;\n"));
    EXPECT_TRUE(
        Has("    // in front\n    ::std::string label;\n    // In letters.\n    ::std::int32_t label_bound"));
}

TEST_F(GeneratedHeader, SaysOfEnumeratorsAndBitsWhatTheIdlSays)
{
    EXPECT_TRUE(
        Has("    // does not turn\n    OFF = 0U,\n    SLOW = 1U,\n    // As fast as it can.\n    FAST"));
    EXPECT_TRUE(Has("    // port\n    RED = 1U,\n    GREEN"));
}

TEST_F(GeneratedHeader, HasNoCommentThatSwallowsTheNextLine)
{
    EXPECT_TRUE(Has("    // of turns\n    ::std::int32_t count = 0;\n"));
}

}  // namespace
