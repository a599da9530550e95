#include "AttentionLines.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace
{
using Ground::CommandProgress;
using testing::ElementsAre;
using testing::IsEmpty;

class AttentionLines : public testing::Test
{
protected:
    std::vector<Ground::FleetRow> _rows{Row("uav1"), Row("uav2")};
    Ground::CommandList _commands;
    Ground::CommandTally _tally;

    static Ground::FleetRow Row(const std::string &node)
    {
        Ground::FleetRow row;
        row.Node = node;
        row.State = Ground::RowState::Up;
        row.AgeS = 0.1;
        return row;
    }
    void Add(const std::string &node, CommandProgress progress, const std::string &reason = "")
    {
        Ground::CommandStatus command;
        command.number = static_cast<std::uint32_t>(_commands.items.size() + 1);
        command.node = node;
        command.kind = Ground::OrderKind::ORDER_SEARCH;
        command.progress = progress;
        command.reason = reason;
        _commands.items.push_back(command);
    }
    std::vector<std::string> Lines(double fleetAgeS = 0.5) const
    {
        return Ground::AttentionLines(_rows, _commands, _tally, fleetAgeS);
    }
};

TEST_F(AttentionLines, AreNoneWhereAllIsWell)
{
    Add("uav1", CommandProgress::PROGRESS_DONE);
    EXPECT_THAT(Lines(), IsEmpty());
}

TEST_F(AttentionLines, TellOfALowBattery)
{
    _rows[0].BatteryPercent = 25;
    _rows[1].BatteryPercent = 24.9;
    EXPECT_THAT(Lines(), ElementsAre("uav2: the battery is at 24 %"));
}

TEST_F(AttentionLines, TellOfABadPosition)
{
    _rows[0].BadPosition = "latitude must be from -90 to 90, not 95";
    EXPECT_THAT(Lines(), ElementsAre("uav1: bad position: latitude must be from -90 to 90, not 95"));
}

TEST_F(AttentionLines, TellWhyTheSearchAreaIsDeclined)
{
    _rows[1].AreaDeclined = "100 m above sea level is below the floor of 460 m";
    EXPECT_THAT(Lines(), ElementsAre("uav2: the search area is declined: 100 m above sea level is below the "
                                     "floor of 460 m"));
}

TEST_F(AttentionLines, TellWhyTheLastCommandIsDeclined)
{
    Add("uav1", CommandProgress::PROGRESS_DONE);
    Add("uav1", CommandProgress::PROGRESS_DECLINED, "the battery is low");
    EXPECT_THAT(Lines(), ElementsAre("uav1: command 2 (search) is declined: the battery is low"));
    Add("uav1", CommandProgress::PROGRESS_SENT);
    EXPECT_THAT(Lines(), IsEmpty()) << "another command came after it";
}

TEST_F(AttentionLines, TellThatACommandMayNotHaveArrived)
{
    Add("uav1", CommandProgress::PROGRESS_IN_DOUBT);
    Add("uav2", CommandProgress::PROGRESS_EXPIRED);
    EXPECT_THAT(Lines(), ElementsAre("uav1: command 1 (search) may or may not have arrived",
                                     "uav2: command 2 (search) was too old on the way and never arrived"));
}

TEST_F(AttentionLines, TellWhatIsMissing)
{
    _rows[0].State = Ground::RowState::Stale;
    EXPECT_THAT(Lines(), ElementsAre("uav1: only its positions come"));
}

TEST_F(AttentionLines, TellWhoIsBackWithoutOrders)
{
    Ground::NodeCommands node;
    node.node = "uav2";
    node.without_orders = true;
    _tally.nodes = {node};
    EXPECT_THAT(Lines(), ElementsAre("uav2: it is back without orders"));
}

TEST_F(AttentionLines, TellOnlyThatTheOwnGatewayIsSilentWhereThatIsWhatIsMissing)
{
    _rows[0].State = Ground::RowState::Stale;
    EXPECT_THAT(Lines(7), ElementsAre("The gateway of this ground station is silent"));
}

TEST_F(AttentionLines, MakeTextsOfTheNetworkPrintable)
{
    _rows[0].AreaDeclined = "\x1b[2J";
    EXPECT_THAT(Lines(), ElementsAre("uav1: the search area is declined: ?[2J"));
}

}  // namespace
