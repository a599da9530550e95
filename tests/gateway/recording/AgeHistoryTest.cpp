#include "recording/merge/AgeHistory.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "recording/merge/AgePlot.h"

namespace Rabit::Merge
{
namespace
{

constexpr Moment Ms = 1000000;

TEST(AgeHistory, GrowsUntilSomethingNewerComes)
{
    AgeHistory ages(0, 10 * OneSecond, 10);
    ages.Receive(2 * OneSecond, 2 * OneSecond - 100 * Ms);
    ages.Receive(5 * OneSecond, 5 * OneSecond - 100 * Ms);
    ages.End(6 * OneSecond);
    const auto &columns = ages.Columns();
    EXPECT_FALSE(columns[1].IsKnown);
    EXPECT_EQ(columns[2].Youngest, 100 * Ms);
    EXPECT_EQ(columns[2].Oldest, OneSecond + 100 * Ms);
    EXPECT_EQ(columns[4].Oldest, 3 * OneSecond + 100 * Ms);
    EXPECT_EQ(columns[5].Youngest, 100 * Ms);
    EXPECT_FALSE(columns[7].IsKnown);
    EXPECT_EQ(ages.Oldest(), 3 * OneSecond + 100 * Ms);
    EXPECT_EQ(ages.OldestAt(), 5 * OneSecond);
    EXPECT_EQ(ages.Values(), 2U);
}

TEST(AgeHistory, TellsWhatAgeWasNotExceededForHowMuchOfTheTime)
{
    AgeHistory ages(0, 100 * OneSecond, 10);
    for (int second = 0; second < 100; ++second)
    {
        ages.Receive(second * OneSecond, second * OneSecond);
    }
    ages.End(100 * OneSecond);
    EXPECT_NEAR(static_cast<double>(ages.Percentile(0.5)), 0.5e9, 0.002e9);
    EXPECT_NEAR(static_cast<double>(ages.Percentile(0.9)), 0.9e9, 0.002e9);
    EXPECT_EQ(AgeHistory(0, 1, 1).Percentile(0.5), 0);
}

TEST(AgeHistory, TakesWhatWasPostedLaterThanItCameForNew)
{
    AgeHistory ages(0, 10 * OneSecond, 10);
    ages.Receive(OneSecond, OneSecond + Ms);
    ages.End(OneSecond + 2 * Ms);
    EXPECT_EQ(ages.Columns()[1].Youngest, 0);
    EXPECT_EQ(ages.Oldest(), Ms);
}

TEST(AgeHistory, HoldsWhateverAFileSays)
{
    AgeHistory ages(5, 5, 0);
    ages.Receive(FarthestMoment, -FarthestMoment);
    ages.Receive(-FarthestMoment, FarthestMoment);
    ages.End(FarthestMoment);
    EXPECT_EQ(ages.Columns().size(), 1U);
}

TEST(AgePlot, DrawsALineForEachMessageInAPanelForEachPair)
{
    AgeHistory pose(0, 100 * OneSecond, AgePlot::Columns);
    pose.Receive(10 * OneSecond, 10 * OneSecond);
    pose.End(60 * OneSecond);
    AgeHistory state = pose;
    state.Receive(80 * OneSecond, 80 * OneSecond);
    state.End(90 * OneSecond);
    AgePlot plot;
    plot.Title = "a < b & c";
    plot.End = 100 * OneSecond;
    plot.Panels = {{"what uav2 knew of uav1", {{"Pose", &pose}, {"State", &state}}},
                   {"what uav1 knew of uav2", {{"Pose", &pose}}}};
    const std::string svg = plot.ToSvg();
    const auto count = [&svg](const std::string &what)
    {
        std::size_t found = 0;
        for (std::size_t at = svg.find(what); at != std::string::npos; at = svg.find(what, at + 1))
        {
            ++found;
        }
        return found;
    };
    EXPECT_EQ(count("<polyline"), 4U);  // that of State is in two parts
    EXPECT_EQ(count(">Pose</text>"), 2U);
    EXPECT_EQ(count("a &lt; b &amp; c"), 1U);
    EXPECT_EQ(count(">time since the beginning (s)</text>"), 1U);
    EXPECT_EQ(count(">age</text>"), 2U);
    EXPECT_EQ(count(">10 s</text>"), 2U);
    EXPECT_EQ(count("nan") + count("inf"), 0U);
}

TEST(AgePlot, EveryMessageHasAColourOfItsOwnAndALineInTheLegend)
{
    AgeHistory ages(0, 100 * OneSecond, AgePlot::Columns);
    ages.Receive(10 * OneSecond, 10 * OneSecond);
    ages.End(60 * OneSecond);
    AgePlot plot;
    plot.End = 100 * OneSecond;
    plot.Panels = {{"what uav2 knew of uav1", {}}};
    constexpr std::size_t messages = 60;
    for (std::size_t i = 0; i < messages; ++i)
    {
        plot.Panels[0].Lines.push_back({"Message" + std::to_string(i), &ages});
    }
    const std::string svg = plot.ToSvg();
    const std::string fill = "fill=\"#";
    std::set<std::string> colours;
    for (std::size_t at = svg.find("<polygon"); at != std::string::npos; at = svg.find("<polygon", at + 1))
    {
        colours.insert(svg.substr(svg.find(fill, at) + fill.size(), 6));
    }
    EXPECT_EQ(colours.size(), messages);
    EXPECT_NE(svg.find(">Message59</text>"), std::string::npos);
    EXPECT_NE(svg.find("height=\"900.0\" fill=\"none\""), std::string::npos);
}

TEST(AgePlot, IsAPictureEvenOfNothing)
{
    const AgeHistory nothing(0, 0, 3);
    AgePlot plot;
    plot.Panels = {{"\x1b<script>", {{"Pose", &nothing}}}};
    const std::string svg = plot.ToSvg();
    EXPECT_NE(svg.find("?&lt;script&gt;"), std::string::npos);
    EXPECT_EQ(svg.find("nan"), std::string::npos);
}

}  // namespace
}  // namespace Rabit::Merge
