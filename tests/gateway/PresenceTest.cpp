// When a gateway sends beats and announcements.
#include <gmock/gmock.h>
#include <rabit/idl/MessageType.h>
#include <rabit/idl/MessageTypeRegistry.h>
#include <rabit/simulated/SimulatedTransport.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "presence/OffersAnswer.h"
#include "HandNode.h"
#include "SimulatedFleet.h"
#include "wire/BeatNews.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;

// Hears one topic of all nodes. Records the sender and the time of each sample.
class Listener
{
public:
    Listener(SimulatedNetwork &network, const std::string &topic, const std::string &type,
             const std::string &name = "listener")
        : _network(network)
    {
        TransportSettings settings;
        settings.Node = name;
        settings.Incarnation = 1;
        _session = SimulatedTransport(network).Open(settings, [](const PeerEvent &) {});
        TopicQos qos;
        qos.Reliability = Reliability::BestEffort;
        _reader = _session->CreateReader({topic, type, {}}, qos, {},
                                         [this](SampleBytes, const SampleInfo &info)
                                         { _heard.emplace_back(info.Node, _network.Now()); });
    }
    // Returns the number of samples that came in [from, to), of one node or of all.
    std::ptrdiff_t Count(std::chrono::nanoseconds from, std::chrono::nanoseconds to,
                         const std::string &node = "") const
    {
        return std::count_if(_heard.begin(), _heard.end(),
                             [&](const auto &sample) {
                                 return (node.empty() || sample.first == node) && sample.second >= from &&
                                        sample.second < to;
                             });
    }
    const std::vector<std::pair<std::string, std::chrono::nanoseconds>> &Heard() const { return _heard; }

private:
    SimulatedNetwork &_network;
    std::vector<std::pair<std::string, std::chrono::nanoseconds>> _heard;
    std::unique_ptr<TransportSession> _session;
    std::unique_ptr<TransportReader> _reader;
};

class BeatListener : public Listener
{
public:
    explicit BeatListener(SimulatedNetwork &network) : Listener(network, "rabit/Beat", "Rabit::Gateway::Beat")
    {
    }
};

GatewayConfig Node(const std::string &name)
{
    GatewayConfig config;
    config.Node = name;
    return config;
}

TEST(Presence, ANodeThatAppearsHearsSeveralBeatsBeforeAPeriodIsOver)
{
    SimulatedFleet fleet{1};
    fleet.Add(Node("uav1"));
    fleet.RunFor(10s);
    const BeatListener listener(fleet.Network);
    const auto appeared = fleet.Network.Now();
    fleet.RunFor(500ms);
    EXPECT_GE(listener.Count(appeared, appeared + 300ms), 1);
    EXPECT_GE(listener.Count(appeared, appeared + 500ms), 2);
}

TEST(Presence, BeatsTwiceASecondOnceAllKnowIt)
{
    SimulatedFleet fleet;
    fleet.Add(Node("uav1"));
    const BeatListener listener(fleet.Network);
    fleet.RunFor(12s);
    EXPECT_EQ(listener.Count(2s, 12s), 20);
}

// Ten aircraft that publish a State, and one more that crashes and starts again each second.
class CrashLoopTest : public ::testing::Test
{
protected:
    static constexpr int Fleet = 10;

    CrashLoopTest()
    {
        for (int i = 0; i < Fleet; ++i)
        {
            SimulatedNode &node = fleet.Add(AircraftConfig(NameOf(i)));
            _states.push_back(node.Register<Uav::MissionState>("MissionState"));
            _states.back()->PostMessage();
        }
        fleet.RunFor(60s);
    }

    static std::string NameOf(int i) { return std::string("uav").append(std::to_string(i)); }

    void CrashEachSecond(int times)
    {
        for (int i = 0; i < times; ++i)
        {
            fleet.Add(AircraftConfig("crasher"));
            fleet.RunFor(1s);
            fleet.Kill("crasher");
        }
    }

    SimulatedFleet fleet{1};

private:
    std::vector<std::shared_ptr<Uav::MissionState>> _states;
};

TEST_F(CrashLoopTest, DoesNotMakeTheOthersShout)
{
    const BeatListener beats(fleet.Network);
    const Listener states(fleet.Network, "MissionState", "Uav::MissionState", "listener2");
    fleet.RunFor(5s);
    const auto start = fleet.Network.Now();
    CrashEachSecond(30);
    const auto end = fleet.Network.Now();
    // In 30 s: a beat each half second and two answers of seven beats each 5 s. No node requests a State,
    // so none is sent.
    for (int i = 0; i < Fleet; ++i)
    {
        EXPECT_LE(beats.Count(start, end, NameOf(i)), 60 + 7 * 2 * 6) << NameOf(i);
        EXPECT_GE(beats.Count(start, end, NameOf(i)), 58) << NameOf(i);
        EXPECT_EQ(states.Count(start, end, NameOf(i)), 0) << NameOf(i);
    }
}

TEST_F(CrashLoopTest, DoesNotKeepANewcomerWaiting)
{
    CrashEachSecond(12);
    fleet.Add(AircraftConfig("crasher"));
    GatewayConfig config = GroundConfig();
    SimulatedNode &ground = fleet.Add(config);
    std::vector<std::shared_ptr<Uav::MissionState>> mirrored;
    for (int i = 0; i < Fleet; ++i)
    {
        mirrored.push_back(ground.Register<Uav::MissionState>(NameOf(i) + "/MissionState"));
    }
    const auto hasAll = [&mirrored]
    {
        return std::all_of(mirrored.begin(), mirrored.end(),
                           [](const auto &state) { return state->FetchMessage() || state->WasPosted(); });
    };
    const auto hearsAll = [&ground]
    {
        for (int i = 0; i < Fleet; ++i)
        {
            if (ground.StateOf(NameOf(i)) != "UP")
            {
                return false;
            }
        }
        return true;
    };
    EXPECT_TRUE(fleet.RunUntil(hearsAll, 1s));
    // The newcomer requests ten announcements and then ten States, in beats at growing intervals. Its
    // readers must also become known to all.
    EXPECT_TRUE(fleet.RunUntil(hasAll, 2500ms));
}

TEST(Presence, ANewcomerHasStatesAsSoonAsTheNodesKnowEachOther)
{
    SimulatedFleet fleet;
    SimulatedNode &uav = fleet.Add(AircraftConfig("uav1"));
    auto state = uav.Register<Uav::MissionState>("MissionState");
    state->PostMessage();
    fleet.RunFor(60s);
    SimulatedNode &ground = fleet.Add(GroundConfig());
    auto mirrored = ground.Register<Uav::MissionState>("uav1/MissionState");
    EXPECT_TRUE(fleet.RunUntil([&] { return ground.StateOf("uav1") == "UP"; }, 1s));
    EXPECT_TRUE(fleet.RunUntil([&] { return mirrored->FetchMessage(); }, 150ms));
}

TEST(Presence, AStateIsNotRepeatedMoreOftenThanItsRateAllows)
{
    SimulatedFleet fleet;
    GatewayConfig config = AircraftConfig("uav1");
    config.Publish[1].MaxRate = 0.25;
    SimulatedNode &uav = fleet.Add(config);
    auto state = uav.Register<Uav::MissionState>("MissionState");
    state->PostMessage();
    fleet.RunFor(3s);
    const Listener listener(fleet.Network, "MissionState", "Uav::MissionState");
    for (int i = 0; i < 20; ++i)
    {
        GatewayConfig asks = Node(std::string("new").append(std::to_string(i)));
        asks.Subscribe.push_back({.Message = "MissionState", .Type = "Uav::MissionState"});
        fleet.Add(asks);
        fleet.RunFor(1s);
    }
    ASSERT_GE(listener.Heard().size(), 4u);
    for (std::size_t i = 1; i < listener.Heard().size(); ++i)
    {
        EXPECT_GE(listener.Heard()[i].second - listener.Heard()[i - 1].second, 3999ms);
    }
}

// A node that has been there for a while, and one by hand that requests and listens.
class AnnouncementTest : public ::testing::Test
{
protected:
    AnnouncementTest()
        : asker(fleet.Network, "asker", 1, [this](SampleBytes bytes, const SampleInfo &) { Hear(bytes); })
    {
        uav = &fleet.Add(AircraftConfig("uav1"));
        fleet.RunFor(10s);
        asker.Write(asker.Beat());
        fleet.RunFor(10s);
        parts = beats = 0;
    }

    void Hear(SampleBytes bytes)
    {
        Gateway::Beat beat;
        ASSERT_TRUE(MessageTypeRegistry::Of(beat)->Deserialize(bytes, beat));
        ++beats;
        parts += static_cast<int>(NewsOf(beat).parts.size());
    }

    void Ask(std::uint32_t tag, std::uint16_t offers = 0)
    {
        Gateway::Beat beat = asker.Beat();
        Gateway::Wanted &wanted = NewsOf(beat).wants.emplace_back();
        wanted.node = tag;
        wanted.offers = offers;
        asker.Write(beat);
    }

    std::uint32_t Tag() { return NodeTagOf("uav1", uav->Fleet().incarnation); }

    SimulatedFleet fleet;
    SimulatedNode *uav = nullptr;
    int beats = 0;
    int parts = 0;
    HandNode asker;
};

TEST_F(AnnouncementTest, IsNotSaidWhileNobodyAsks)
{
    fleet.RunFor(60s);
    EXPECT_EQ(parts, 0);
    EXPECT_EQ(beats, 120);
}

TEST_F(AnnouncementTest, IsSaidAgainToWhoAsks)
{
    Ask(Tag());
    fleet.RunFor(100ms);
    EXPECT_EQ(parts, 1);
}

TEST_F(AnnouncementTest, IsNotSaidToWhoAsksSomebodyElse)
{
    Ask(Tag() + 1);
    fleet.RunFor(5s);
    EXPECT_EQ(parts, 0);
}

TEST_F(AnnouncementTest, IsNotSaidFromBeyondItsEnd)
{
    Ask(Tag(), 60000);
    fleet.RunFor(5s);
    EXPECT_EQ(parts, 0);
}

TEST_F(AnnouncementTest, IsNotSaidOftenHoweverOftenItIsAskedFor)
{
    for (int i = 0; i < 1000; ++i)
    {
        Ask(Tag());
        fleet.RunFor(10ms);
    }
    EXPECT_GE(parts, 8);
    EXPECT_LE(parts, 10 + OffersAnswer::QuickAnswers);
    EXPECT_LE(beats, 20 + 10 + OffersAnswer::QuickAnswers);
}

// The other nodes accept the node's beats only once one of these echoes theirs: beats that were held up on
// the way look alike.
TEST(PresenceAfterAStandstill, ANodeOfAHundredIsUpForAllWithinSomeBeats)
{
    for (const double budget : {0.0, 5000.0})
    {
        SimulatedFleet fleet;
        GatewayConfig config = AircraftConfig("uav1");
        if (budget > 0.0)
        {
            config.Radio.Budget = budget;
        }
        fleet.Add(config);
        SimulatedNode &first = fleet.Add(AircraftConfig("a"));
        SimulatedNode &last = fleet.Add(GroundConfig());
        std::vector<std::unique_ptr<HandNode>> others;
        for (int i = 0; i < 98; ++i)
        {
            others.push_back(
                std::make_unique<HandNode>(fleet.Network, std::string("n").append(std::to_string(i)), 1));
        }
        const auto beat = [&](std::chrono::nanoseconds duration, const std::function<bool()> &until)
        {
            for (auto passed = 0ms; passed < duration && !until(); passed += 500ms)
            {
                for (const auto &other : others)
                {
                    other->Write(other->Beat());
                }
                fleet.RunUntil(until, 500ms);
            }
        };
        beat(60s, [] { return false; });
        ASSERT_EQ(first.StateOf("uav1"), "UP");
        fleet.StandStill("uav1", 10s);
        EXPECT_EQ(first.StateOf("uav1"), "LOST");
        EXPECT_EQ(last.StateOf("uav1"), "LOST");
        const auto since = fleet.Network.Now();
        beat(60s, [&] { return first.StateOf("uav1") == "UP" && last.StateOf("uav1") == "UP"; });
        EXPECT_LE(fleet.Network.Now() - since, 3s) << "with a budget of " << budget;
    }
}

}  // namespace
}  // namespace Rabit
