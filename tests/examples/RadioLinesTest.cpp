#include "RadioLines.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

namespace
{
using Ground::Emphasis;
using Ground::RadioLogLine;
using Ground::RadioTableLines;
using Ground::RadioUse;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr double NaN = std::numeric_limits<double>::quiet_NaN();
constexpr double Infinity = std::numeric_limits<double>::infinity();
constexpr double Huge = std::numeric_limits<double>::max();

std::vector<std::string> Texts(const std::vector<Ground::TableLine> &lines)
{
    std::vector<std::string> texts;
    for (const auto &line : lines)
        texts.push_back(line.Text);
    return texts;
}

RadioUse Unlimited()
{
    RadioUse use;
    use.Known = true;
    use.Air.used = 1230;
    use.Air.presence = 400;
    use.Air.telemetry = 830;
    return use;
}

RadioUse Limited()
{
    RadioUse use = Unlimited();
    use.Air.budget = 5000;
    use.Air.used = 4940;
    use.Air.command = 90;
    use.Air.telemetry = 4240;
    use.Air.discovery = 210;
    return use;
}

RadioUse HeldBack()
{
    RadioUse use = Limited();
    use.Streams = {{"Pose", 10, 6.24}};
    use.PostsHeldPerS = 3.76;
    use.Links = {{"uav2", "MissionControl", 3, 2}, {"uav3", "MissionControl", 1, 0}};
    use.MessagesHeld = 4;
    return use;
}

TEST(RadioLines, AreNoneBeforeTheFirstFleet)
{
    EXPECT_THAT(RadioTableLines(RadioUse(), Infinity, 80), IsEmpty());
    EXPECT_EQ(RadioLogLine(RadioUse(), Infinity, 12), "");
}

TEST(RadioLines, AreOneShortOneWhereNothingLimitsTheRadio)
{
    const auto lines = RadioTableLines(Unlimited(), 0.5, 80);
    EXPECT_THAT(Texts(lines), ElementsAre("Radio: not limited, 1.2 kB/s used"));
    EXPECT_EQ(lines[0].Shown, Emphasis::None);
    EXPECT_EQ(RadioLogLine(Unlimited(), 0.5, 12.4), "   12.4 s  radio not limited, 1.2 kB/s used");
}

TEST(RadioLines, TellWhatEachClassUsesOfABudgetAndWhatDiscoveryDoes)
{
    const auto lines = RadioTableLines(Limited(), 0.5, 80);
    EXPECT_THAT(Texts(lines),
                ElementsAre("Radio: budget 5.0 kB/s, 4.9 kB/s used",
                            "  kB/s: presence 0.40, command 0.09, telemetry 4.24, discovery 0.21"));
    EXPECT_EQ(lines[0].Shown, Emphasis::None) << "nothing is held back";
    EXPECT_EQ(RadioLogLine(Limited(), 0.5, 12.4),
              "   12.4 s  radio budget 5.0 kB/s, 4.9 kB/s used; kB/s: presence 0.40, command 0.09, telemetry "
              "4.24, discovery 0.21");
}

TEST(RadioLines, TellWhatTheAirCarriesIfThatLimits)
{
    RadioUse use = Limited();
    use.Air.capacity = 3210;
    EXPECT_EQ(RadioTableLines(use, 0, 80)[0].Text,
              "Radio: budget 5.0 kB/s, the air carries 3.2 kB/s, 4.9 kB/s used");
    use.Air.budget = 0;
    EXPECT_EQ(RadioTableLines(use, 0, 80)[0].Text, "Radio: the air carries 3.2 kB/s, 4.9 kB/s used");
}

TEST(RadioLines, NameWhatIsHeldBackCommandsFirst)
{
    const auto lines = RadioTableLines(HeldBack(), 0, 80);
    EXPECT_THAT(Texts(lines),
                ElementsAre("Radio: budget 5.0 kB/s, 4.9 kB/s used; held back: 3.8 posts/s, 4 queue messages",
                            "  kB/s: presence 0.40, command 0.09, telemetry 4.24, discovery 0.21",
                            "  uav2/MissionControl: 3 wait, 2 expired", "  uav3/MissionControl: 1 waits",
                            "  Pose: 10.0/s posted, 6.2/s sent"));
    EXPECT_EQ(lines[0].Shown, Emphasis::Warning);
    EXPECT_EQ(
        RadioLogLine(HeldBack(), 0, 12.4),
        "   12.4 s  radio budget 5.0 kB/s, 4.9 kB/s used; held back: 3.8 posts/s, 4 queue messages; kB/s: "
        "presence 0.40, command 0.09, telemetry 4.24, discovery 0.21; uav2/MissionControl: 3 wait, 2 "
        "expired; uav3/MissionControl: 1 waits; Pose: 10.0/s posted, 6.2/s sent");
}

TEST(RadioLines, CountWhatIsBeyondTheFirstFew)
{
    RadioUse use = Limited();
    for (int i = 1; i <= 4; ++i)
        use.Links.push_back({std::string("uav").append(std::to_string(i)), "Q", 1, 0});
    for (int i = 1; i <= 4; ++i)
        use.Streams.push_back({std::string("M").append(std::to_string(i)), 10, 5});
    const auto lines = Texts(RadioTableLines(use, 0, 80));
    ASSERT_EQ(lines.size(), 2 + Ground::HeldOnScreen + 1);
    EXPECT_EQ(lines[6], "  M1: 10.0/s posted, 5.0/s sent");
    EXPECT_EQ(lines.back(), "  and 3 more");
}

TEST(RadioLines, CountNothingBeyondIfAllIsNamed)
{
    RadioUse use = Limited();
    for (int i = 1; i <= 5; ++i)
        use.Links.push_back({std::string("uav").append(std::to_string(i)), "Q", 1, 0});
    EXPECT_EQ(RadioTableLines(use, 0, 80).back().Text, "  uav5/Q: 1 waits");
    use.Streams.push_back({"M", 10, 5});
    EXPECT_EQ(RadioTableLines(use, 0, 80).back().Text, "  and 1 more");
}

TEST(RadioLines, SayHowOldTheyAreIfTheGatewayHasStopped)
{
    const auto lines = RadioTableLines(Unlimited(), 61, 80);
    EXPECT_EQ(lines[0].Text, "Radio: not limited, 1.2 kB/s used (61 s ago)");
    EXPECT_EQ(lines[0].Shown, Emphasis::Warning);
    EXPECT_EQ(RadioLogLine(Unlimited(), 61, 0), "    0.0 s  radio not limited, 1.2 kB/s used (61 s ago)");
}

TEST(RadioLines, StayWithinTheColumns)
{
    RadioUse use = HeldBack();
    use.Air.state = use.Air.bulk = 123;
    for (const auto &line : RadioTableLines(use, 0, 80))
        EXPECT_LE(line.Text.size(), 80u) << line.Text;
}

TEST(RadioLines, StayShortWithNumbersThatMakeNoSense)
{
    for (const double value : {NaN, Infinity, -Infinity, Huge, -1.0})
    {
        RadioUse use = HeldBack();
        use.Air.budget = use.Air.capacity = use.Air.used = value;
        use.Air.presence = use.Air.command = use.Air.state = value;
        use.Air.telemetry = use.Air.bulk = use.Air.discovery = value;
        use.PostsHeldPerS = use.Streams[0].PostedPerS = use.Streams[0].SentPerS = value;
        use.Links[0].Waiting = use.Links[0].Expired = std::numeric_limits<std::uint64_t>::max();
        for (const auto &line : RadioTableLines(use, value, 80))
            EXPECT_LE(line.Text.size(), 450u) << line.Text;
        EXPECT_LE(RadioLogLine(use, value, 0).size(), 900u);
    }
}

TEST(RadioLines, NeverPrintControlCharactersFromTheNetwork)
{
    RadioUse use = Limited();
    use.Links = {{"a\x1b[2J", "b\n", 1, 0}};
    use.Streams = {{"c\xff", 10, 5}};
    EXPECT_EQ(RadioTableLines(use, 0, 80)[2].Text, "  a?[2J/b?: 1 waits");
    EXPECT_EQ(RadioTableLines(use, 0, 80)[3].Text, "  c?: 10.0/s posted, 5.0/s sent");
    EXPECT_THAT(RadioLogLine(use, 0, 0), testing::HasSubstr("a?[2J/b?: 1 waits; c?: "));
}

}  // namespace
