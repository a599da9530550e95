// Search areas.
#include "CommanderFixture.h"

namespace
{
using namespace std::chrono_literals;
using CommanderTests::Commander;

// Aircraft and areas: uav1 reports the number of its area.
class AreaCommander : public Commander
{
protected:
    void SetUp() override
    {
        Commander::SetUp();
        _workspace.AddPublishSubscribeMessage("uav1/MissionState", _state);
    }
    void Report(std::uint32_t area)
    {
        _state->search_area = area;
        _state->PostMessage();
        Run(200ms);
    }
    void Want(float northM)
    {
        auto area = std::make_shared<Uav::SearchArea>();
        area->north_m = northM;
        ASSERT_TRUE(_workspace.AddMessageToQueue("Commands", area));
        Run(200ms);
    }
    // The number, and its length to the north.
    std::pair<std::uint32_t, float> Posted()
    {
        Uav::SearchArea area;
        _workspace.ForceFetchMessage("SearchArea", &area);
        return area.WasPosted() ? std::pair(area.number, area.north_m) : std::pair(std::uint32_t{0}, 0.0F);
    }
    Ground::AreaList Listed()
    {
        Ground::AreaList list;
        _workspace.ForceFetchMessage("AreaList", &list);
        return list;
    }
    static Ground::Commander::Settings WithArea()
    {
        Ground::Commander::Settings settings;
        settings.Area.emplace().north_m = 100;
        return settings;
    }

    std::shared_ptr<Uav::MissionState> _state = std::make_shared<Uav::MissionState>();
};

TEST_F(AreaCommander, PublishesNoAreaThatNobodyAskedFor)
{
    Start({});
    Run(1s);
    Report(0);
    EXPECT_EQ(Posted().first, 0U);
}

TEST_F(AreaCommander, PublishesTheFirstAreaOnceAnAircraftReportsThatItHasNone)
{
    Start(WithArea());
    Run(5s);
    EXPECT_EQ(Posted().first, 0U) << "the fleet may have one";
    Report(0);
    EXPECT_EQ(Posted(), std::pair(1U, 100.0F));
}

// As after a restart: the first area of the options is an old one by now.
TEST_F(AreaCommander, LeavesAFleetTheAreaThatItHas)
{
    Start(WithArea());
    Report(5);
    Run(5s);
    EXPECT_EQ(Posted().first, 0U);
    Want(321);
    EXPECT_EQ(Posted(), std::pair(6U, 321.0F));
}

TEST_F(AreaCommander, NumbersAWantedAreaAnewIfAnAircraftComesBackWithAHigherNumber)
{
    Start({});
    Want(321);
    EXPECT_EQ(Posted(), std::pair(1U, 321.0F));
    Report(5);
    EXPECT_EQ(Posted(), std::pair(6U, 321.0F));
    Report(6);
    EXPECT_EQ(Posted().first, 6U);
    Want(400);
    EXPECT_EQ(Posted(), std::pair(7U, 400.0F));
}

TEST_F(AreaCommander, ListsAnAreaWithWhatBecomesOfItAtEachAircraft)
{
    Start({});
    Run(200ms);
    Report(0);
    Want(321);
    EXPECT_EQ(Listed().items.at(0).area.number, 1u);
    EXPECT_EQ(Listed().items.at(0).area.north_m, 321);
    ASSERT_EQ(Listed().items.at(0).answers.size(), 1u);
    EXPECT_EQ(Listed().items[0].answers[0].progress, Ground::AreaProgress::AREA_SENT);
    Report(1);
    EXPECT_EQ(Listed().items[0].answers[0].progress, Ground::AreaProgress::AREA_FLOWN);
    Want(400);
    _state->area_declined = "60 m outside of the geofence";
    Report(1);
    const Ground::AreaList list = Listed();
    ASSERT_EQ(list.items.size(), 2u);
    EXPECT_EQ(list.items[0].answers.at(0).progress, Ground::AreaProgress::AREA_FLOWN);
    EXPECT_EQ(list.items[1].answers.at(0).progress, Ground::AreaProgress::AREA_DECLINED);
    EXPECT_EQ(list.items[1].answers.at(0).reason, "60 m outside of the geofence");
    EXPECT_EQ(list.items[1].answers.at(0).flies, 1u);
}

TEST_F(AreaCommander, CountsNoReplayAmongTheAircraft)
{
    Start({});
    _fleet->nodes[0].replay = true;
    _fleet->PostMessage();
    Run(200ms);
    Report(4);
    Want(321);
    EXPECT_TRUE(Listed().items.at(0).answers.empty());
}

}  // namespace
