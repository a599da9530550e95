#include "TerminalScreen.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace
{
using Ground::Emphasis;
using Ground::TerminalScreen;
using testing::HasSubstr;

TEST(TerminalScreen, DrawsBelowTheCursorTheFirstTime)
{
    TerminalScreen screen;
    EXPECT_EQ(screen.Redraw({{"one"}, {"two"}}, {80, 24}), "\x1b[Kone\n\x1b[Ktwo\n\x1b[J");
}

TEST(TerminalScreen, GoesBackUpOverTheLinesDrawnBefore)
{
    TerminalScreen screen;
    screen.Redraw({{"one"}, {"two"}}, {80, 24});
    EXPECT_EQ(screen.Redraw({{"three"}}, {80, 24}), "\x1b[2A\r\x1b[Kthree\n\x1b[J");
    EXPECT_EQ(screen.Redraw({{"four"}}, {80, 24}), "\x1b[1A\r\x1b[Kfour\n\x1b[J");
}

TEST(TerminalScreen, CutsLinesAtTheWidthOfTheTerminal)
{
    TerminalScreen screen;
    EXPECT_EQ(screen.Redraw({{"a long line"}}, {6, 24}), "\x1b[Ka long\n\x1b[J");
}

TEST(TerminalScreen, SaysHowManyLinesDoNotFit)
{
    TerminalScreen screen;
    EXPECT_EQ(screen.Redraw({{"1"}, {"2"}, {"3"}, {"4"}, {"5"}}, {80, 4}),
              "\x1b[K1\n\x1b[K2\n\x1b[K... 3 more\n\x1b[J");
    EXPECT_EQ(screen.Redraw({{"1"}}, {80, 4}), "\x1b[3A\r\x1b[K1\n\x1b[J");
}

TEST(TerminalScreen, ClearsEverythingWhenTheTerminalHasChangedItsSize)
{
    TerminalScreen screen;
    screen.Redraw({{"one"}}, {80, 24});
    EXPECT_EQ(screen.Redraw({{"one"}}, {60, 24}), "\x1b[2J\x1b[H\x1b[Kone\n\x1b[J");
}

TEST(TerminalScreen, LeavesALineOfTheLogAboveTheOthersForGood)
{
    TerminalScreen screen;
    screen.Redraw({{"one"}, {"two"}}, {80, 24});
    EXPECT_EQ(screen.Redraw({{"one"}, {"two"}}, {80, 24}, {"a warning"}),
              "\x1b[2A\r\x1b[Ja warning\n\x1b[Kone\n\x1b[Ktwo\n\x1b[J");
    EXPECT_EQ(screen.Redraw({{"one"}}, {80, 24}), "\x1b[2A\r\x1b[Kone\n\x1b[J") << "it is not drawn over";
}

TEST(TerminalScreen, EndsTheStyleOfALineWithTheLine)
{
    TerminalScreen screen;
    EXPECT_EQ(screen.Redraw({{"lost", Emphasis::Alarm}}, {3, 24}), "\x1b[K\x1b[1;31mlos\x1b[0m\n\x1b[J");
}

TEST(TerminalScreen, ShowsTheLostAircraftOfAFleetThatIsTooLargeForIt)
{
    std::vector<Ground::FleetRow> rows(20);
    for (std::size_t i = 0; i < rows.size(); ++i)
    {
        rows[i].Node = "uav" + std::to_string(i + 1);
        rows[i].State = i < 18 ? Ground::RowState::Up : Ground::RowState::Lost;
    }
    Ground::TerminalScreen screen;
    const std::string text = screen.Redraw(Ground::FleetTableLines(rows, 0), {80, 12});
    EXPECT_THAT(text, HasSubstr("12 more"));
    EXPECT_THAT(text, HasSubstr("uav19    LOST"));
    EXPECT_THAT(text, HasSubstr("uav20    LOST"));
}

}  // namespace
