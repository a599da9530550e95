#include "AreaLines.h"

#include <gtest/gtest.h>

#include <string>

namespace
{
using Ground::AreaProgress;

class AreaLines : public testing::Test
{
protected:
    Ground::AreaList _list;

    void Give(std::uint32_t number) { _list.items.emplace_back().area.number = number; }
    void Answer(const std::string &node, AreaProgress progress)
    {
        Ground::AreaAnswer answer;
        answer.node = node;
        answer.progress = progress;
        _list.items.back().answers.push_back(answer);
    }
};

TEST_F(AreaLines, AreNoneWithoutAnArea)
{
    EXPECT_TRUE(Ground::AreaTableLines(_list).empty());
}

TEST_F(AreaLines, TellHowManyFlyTheWantedAreaAndWhoDeclinesIt)
{
    Give(1);
    Give(2);
    for (const char *const node : {"uav1", "uav2", "uav3"})
        Answer(node, AreaProgress::AREA_DECLINED);
    const auto lines = Ground::AreaTableLines(_list);
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_EQ(lines[0].Text, "Search area: 0 of 3 fly area 2; declined by uav1, uav2, uav3");
    EXPECT_EQ(lines[0].Shown, Ground::Emphasis::Warning);
}

TEST_F(AreaLines, WarnOfNothingOnceAllFlyIt)
{
    Give(2);
    Answer("uav1", AreaProgress::AREA_FLOWN);
    const auto lines = Ground::AreaTableLines(_list);
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_EQ(lines[0].Text, "Search area: 1 of 1 fly area 2");
    EXPECT_EQ(lines[0].Shown, Ground::Emphasis::None);
}

TEST_F(AreaLines, TellEachOutcomeAndCountManyAircraft)
{
    Give(5);
    Answer("uav1", AreaProgress::AREA_FLOWN);
    Answer("uav2", AreaProgress::AREA_REPLACED);
    for (int i = 3; i < 8; ++i)
        Answer("uav" + std::to_string(i), AreaProgress::AREA_SENT);
    EXPECT_EQ(Ground::AreaText(_list.items[0]),
              "1 of 7 fly area 5; not answered by 5 aircraft; replaced at uav2");
}

TEST_F(AreaLines, MakeNamesOfTheNetworkPrintable)
{
    Give(5);
    Answer("\x1b[2J", AreaProgress::AREA_SENT);
    EXPECT_EQ(Ground::AreaText(_list.items[0]), "0 of 1 fly area 5; not answered by ?[2J");
}

}  // namespace
