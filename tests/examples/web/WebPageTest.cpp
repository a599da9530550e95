#include "WebPage.h"

#include "PageClient.h"

#include <rabit/ManualClock.h>
#include <rabit/RabitSteppedReactor.h>
#include <rabit/gateway/GatewayManager.h>

#include <nlohmann/json.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace
{
using namespace std::chrono_literals;
using GroundTest::PageClient;
using Json = nlohmann::json;
using Queue = Rabit::RabitMessageQueue<std::shared_ptr<Rabit::RabitMessage>>;
using Rabit::Gateway::NodeState;

// The manager under a clock that the test advances, behind a real server.
class WebPage : public testing::Test
{
protected:
    std::shared_ptr<Rabit::ManualClock> _clock = std::make_shared<Rabit::ManualClock>(1.4e9);
    Rabit::RabitWorkspace _workspace{_clock};
    Rabit::RabitSteppedReactor _reactor{_workspace};
    std::shared_ptr<Rabit::Gateway::Fleet> _fleet = std::make_shared<Rabit::Gateway::Fleet>();
    std::shared_ptr<Uav::Pose> _pose = std::make_shared<Uav::Pose>();
    std::shared_ptr<Uav::Targets> _targets = std::make_shared<Uav::Targets>();
    std::shared_ptr<Queue> _orders = std::make_shared<Queue>(10, "Commands");
    std::unique_ptr<PageClient> _page;

    void SetUp() override
    {
        _workspace.AddPublishSubscribeMessage(Rabit::FleetMessageName, _fleet);
        _workspace.AddPublishSubscribeMessage("uav1/Pose", _pose);
        _workspace.AddPublishSubscribeMessage("uav1.vision/Targets", _targets);
    }
    void Start(std::vector<std::string> expected = {})
    {
        auto server = std::make_unique<Ground::WebServer>(Ground::WebServer::Settings{});
        _page = std::make_unique<PageClient>(server->Endpoint());
        _reactor.AddManager(std::make_unique<Ground::WebPage>(
            Ground::WebPage::Settings{"ground", std::move(expected), {{"Slow", 1}}}, std::move(server),
            _workspace));
        _reactor.Start();
        _reactor.RunDue();
        ASSERT_EQ(_page->Open(), 101u);
    }
    void PostFleet(std::vector<std::pair<std::string, NodeState>> nodes)
    {
        _fleet->nodes.clear();
        for (const auto &[node, state] : nodes)
        {
            Rabit::Gateway::NodeStatus status;
            status.node = node;
            status.state = state;
            status.last_heard_s = 0.2;
            _fleet->nodes.push_back(status);
        }
        _fleet->PostMessage();
    }
    // Returns the snapshot that the page gets one period later.
    Json Shown()
    {
        _reactor.RunFor(*_clock, Ground::WebPage::Period);
        const double now = std::chrono::duration<double>(_clock->Monotonic()).count();
        while (const auto text = _page->NextSeen())
        {
            Json message = Json::parse(*text);
            if (message["type"] == "snapshot" && message["server_s"].get<double>() > now - 0.05)
                return message;
        }
        ADD_FAILURE() << "no snapshot came";
        return {};
    }
    Json Ask(const Json &request)
    {
        EXPECT_TRUE(_page->Send(request.dump()));
        while (const auto text = _page->NextSeen())
        {
            Json message = Json::parse(*text);
            if (message["type"] != "snapshot")
                return message;
        }
        ADD_FAILURE() << "no reply came";
        return {};
    }
    template <typename Message>
    std::shared_ptr<Message> TakeOrder()
    {
        std::shared_ptr<Rabit::RabitMessage> message;
        return _orders->GetMessage(message) ? std::dynamic_pointer_cast<Message>(message) : nullptr;
    }
};

TEST_F(WebPage, ShowsAnAircraftOnceItsPoseComes)
{
    Start();
    PostFleet({{"uav1", NodeState::UP}, {"uav1.vision", NodeState::UP}, {"other", NodeState::UP}});
    EXPECT_EQ(Shown()["aircraft"], Json::array());
    _pose->latitude_deg = 47;
    _pose->PostMessage();
    const Json shown = Shown();
    ASSERT_EQ(shown["aircraft"].size(), 1u);
    EXPECT_EQ(shown["aircraft"][0]["node"], "uav1");
    EXPECT_EQ(shown["aircraft"][0]["state"], "up");
    EXPECT_EQ(shown["aircraft"][0]["pose"]["latitude_deg"], 47);
}

TEST_F(WebPage, KeepsTheLastGoodPositionAndSaysThatTheNewestIsBad)
{
    Start();
    _pose->latitude_deg = 47;
    _pose->altitude_m = 500;
    _pose->PostMessage();
    PostFleet({{"uav1", NodeState::UP}});
    EXPECT_FALSE(Shown()["aircraft"][0].contains("bad_position"));
    for (const double latitude : {95.0, std::numeric_limits<double>::quiet_NaN(), 48.0})
    {
        _pose->latitude_deg = latitude;
        _pose->PostMessage();
        const Json shown = Shown()["aircraft"][0];
        EXPECT_TRUE(shown.contains("bad_position")) << latitude;
        EXPECT_EQ(shown["pose"]["latitude_deg"], 47) << latitude;
    }
    EXPECT_NEAR(Shown()["aircraft"][0]["pose"]["age_s"].get<double>(), 0.5, 0.001) << "it grows old";
    _pose->latitude_deg = 47;
    _pose->PostMessage();
    const Json shown = Shown()["aircraft"][0];
    EXPECT_FALSE(shown.contains("bad_position"));
    EXPECT_NEAR(shown["pose"]["age_s"].get<double>(), 0.1, 0.001);
}

TEST_F(WebPage, ShowsAnAircraftThatHasHadBadPositionsOnly)
{
    Start();
    _pose->altitude_m = 1e300;
    _pose->PostMessage();
    PostFleet({{"uav1", NodeState::UP}});
    const Json shown = Shown();
    ASSERT_EQ(shown["aircraft"].size(), 1u);
    EXPECT_EQ(shown["aircraft"][0]["bad_position"], "altitude must be from -1000 to 30000, not 1e+300");
    EXPECT_FALSE(shown["aircraft"][0].contains("pose"));
}

TEST_F(WebPage, ShowsAnExpectedAircraftBeforeItIsHeard)
{
    Start({"uav2"});
    const Json shown = Shown();
    ASSERT_EQ(shown["aircraft"].size(), 1u);
    EXPECT_EQ(shown["aircraft"][0]["state"], "waiting");
}

TEST_F(WebPage, NamesTheNodesThatAreThereAndReplay)
{
    Start();
    PostFleet({{"uav1", NodeState::UP},
               {"uav2", NodeState::STALE},
               {"uav3", NodeState::LOST},
               {"uav4", NodeState::UP}});
    for (auto &status : _fleet->nodes)
        status.replay = status.node != "uav4";
    _fleet->PostMessage();
    EXPECT_EQ(Shown()["replayed"], Json({"uav1", "uav2"}));
}

TEST_F(WebPage, ShowsTheRadioOnceTheGatewayHasToldOfIt)
{
    Start({"uav1"});
    EXPECT_TRUE(Shown()["radio"].is_null());
    _fleet->air.used = 1230;
    PostFleet({{"uav1", NodeState::UP}});
    const Json shown = Shown();
    EXPECT_EQ(shown["radio"]["air"]["used"], 1230);
    EXPECT_TRUE(shown["aircraft"][0]["delivery_rate"].is_null()) << "it is not known";
}

TEST_F(WebPage, ShowsWhatIsHeldBackByABudgetButNotByTheConfiguration)
{
    Start({"uav1"});
    _fleet->air.budget = 5000;
    _fleet->publications.resize(2);
    _fleet->publications[0].message = "Pose";
    _fleet->publications[1].message = "Slow";
    for (int i = 0; i < 3; ++i)
    {
        for (auto &publication : _fleet->publications)
            publication.offered += 10;
        _fleet->publications[0].replaced += 4;
        _fleet->publications[1].replaced += 9;
        PostFleet({{"uav1", NodeState::UP}});
        _reactor.RunFor(*_clock, 1s);
    }
    const Json streams = Shown()["radio"]["streams"];
    EXPECT_EQ(streams["items"], Json::parse(R"([{"message": "Pose", "posted_per_s": 10, "sent_per_s": 6}])"));
}

TEST_F(WebPage, LetsWhatItShowsGrowOld)
{
    Start();
    _pose->PostMessage();
    _targets->items.emplace_back().name.aircraft = "uav1";
    _targets->PostMessage();
    PostFleet({{"uav1", NodeState::UP}});
    _reactor.RunFor(*_clock, 1900ms);
    const Json shown = Shown();
    EXPECT_NEAR(shown["aircraft"][0]["pose"]["age_s"].get<double>(), 2, 0.001);
    EXPECT_NEAR(shown["targets"][0]["age_s"].get<double>(), 2, 0.001);
    EXPECT_NEAR(shown["aircraft"][0]["heard_s"].get<double>(), 2.2, 0.001);
    EXPECT_EQ(shown["aircraft"][0]["state"], "up");
    _reactor.RunFor(*_clock, 2s);
    EXPECT_EQ(Shown()["aircraft"][0]["state"], "stale") << "its gateway has fallen silent";
}

TEST_F(WebPage, ShowsTheCommandsAndTheSearchArea)
{
    auto list = std::make_shared<Ground::CommandList>();
    auto areas = std::make_shared<Ground::AreaList>();
    _workspace.AddPublishSubscribeMessage("CommandList", list);
    _workspace.AddPublishSubscribeMessage("AreaList", areas);
    Start();
    list->items.emplace_back().node = "uav1";
    list->items.back().steps.emplace_back();
    list->PostMessage();
    areas->items.emplace_back().area.number = 4;
    areas->PostMessage();
    const Json shown = Shown();
    EXPECT_EQ(shown["commands"][0]["node"], "uav1");
    EXPECT_EQ(shown["area"]["number"], 4);
    EXPECT_EQ(shown["events"].size(), 2u);
}

TEST_F(WebPage, KnowsTheAgeOfAPictureByTheClockOfItsAircraft)
{
    Start();
    _pose->gps_time_s = 5000;  // whatever that clock says
    _pose->PostMessage();
    PostFleet({{"uav1", NodeState::UP}});
    auto picture = std::make_shared<Uav::Picture>();
    picture->taken_by = "uav1";
    picture->number = 9;
    picture->pose.gps_time_s = 4997;
    picture->jpeg = {0xFF, 0xD8, 0xFF, 0};
    ASSERT_TRUE(_workspace.AddMessageToQueue("Pictures", picture));
    Json shown = Shown()["aircraft"][0]["picture"];
    EXPECT_EQ(shown["number"], 9);
    EXPECT_NEAR(shown["age_s"].get<double>(), 3.1, 0.001);
    // A clock that is set back does not make a picture young again.
    _pose->gps_time_s = 100;
    _pose->PostMessage();
    shown = Shown()["aircraft"][0]["picture"];
    EXPECT_NEAR(shown["age_s"].get<double>(), 0.1, 0.001);
}

TEST_F(WebPage, KeepsTheLastGoodPictureWhenABadOneComes)
{
    Start();
    _pose->PostMessage();
    PostFleet({{"uav1", NodeState::UP}});
    auto picture = std::make_shared<Uav::Picture>();
    picture->taken_by = "uav1";
    picture->number = 1;
    picture->jpeg = {0xFF, 0xD8, 0xFF, 0};
    _workspace.AddMessageToQueue("Pictures", picture);
    EXPECT_EQ(Shown()["aircraft"][0]["picture"]["number"], 1);
    auto bad = std::make_shared<Uav::Picture>(*picture);
    bad->number = 2;
    bad->jpeg = {'<', 's', 'v', 'g'};
    _workspace.AddMessageToQueue("Pictures", bad);
    EXPECT_EQ(Shown()["aircraft"][0]["picture"]["number"], 1);
}

TEST_F(WebPage, HandsOrdersAndAreasToTheCommander)
{
    _workspace.AddManagerMessageQueue("Commands", _orders);
    Start();
    EXPECT_EQ(Ask({{"type", "order"}, {"ref", 1}, {"kind", "home"}, {"node", "uav1"}}),
              Json({{"type", "reply"}, {"ref", 1}, {"ok", true}}));
    const auto order = TakeOrder<Ground::Order>();
    ASSERT_NE(order, nullptr);
    EXPECT_EQ(order->kind, Ground::OrderKind::ORDER_HOME);
    EXPECT_EQ(Ask({{"type", "area"},
                   {"ref", 2},
                   {"latitude_deg", 47},
                   {"longitude_deg", 8},
                   {"north_m", 100},
                   {"east_m", 200},
                   {"altitude_m", 500},
                   {"speed_mps", 10},
                   {"lane_m", 50}})["ok"],
              true);
    const auto area = TakeOrder<Uav::SearchArea>();
    ASSERT_NE(area, nullptr);
    EXPECT_EQ(area->east_m, 200);
}

TEST_F(WebPage, SaysWhyAnOrderWasNotTaken)
{
    Start();
    const Json home = {{"type", "order"}, {"ref", 1}, {"kind", "home"}, {"node", "uav1"}};
    EXPECT_EQ(Ask(home)["reason"], "the ground station takes no orders now") << "there is no Commander";
    EXPECT_EQ(Ask({{"type", "order"}})["reason"], "'ref' is missing");
    EXPECT_EQ(Ask(Json::array())["ref"], nullptr);
}

TEST_F(WebPage, TakesSoManyOrdersInASecondAndNoMore)
{
    _orders = std::make_shared<Queue>(1000, "Commands");
    _workspace.AddManagerMessageQueue("Commands", _orders);
    Start();
    const Json home = {{"type", "order"}, {"ref", 1}, {"kind", "home"}, {"node", "uav1"}};
    for (int i = 0; i < Ground::WebPage::MaxOrdersPerSecond; ++i)
        ASSERT_EQ(Ask(home)["ok"], true);
    EXPECT_EQ(Ask(home)["reason"], "too many orders within a second");
    _clock->Advance(1s);
    EXPECT_EQ(Ask(home)["ok"], true);
}

TEST_F(WebPage, TellsThePageItsClock)
{
    Start();
    const Json reply = Ask({{"type", "clock"}, {"page_s", 3.5}});
    EXPECT_EQ(reply["page_s"], 3.5);
    EXPECT_NEAR(reply["server_s"].get<double>(), std::chrono::duration<double>(_clock->Monotonic()).count(),
                1e-6);
}

}  // namespace
