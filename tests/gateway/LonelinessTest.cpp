#include "report/Loneliness.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "../core/CapturedLog.h"
#include "BeatSamples.h"
#include "SimulatedFleet.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

class LonelinessTest : public ::testing::Test
{
protected:
    LonelinessTest()
    {
        config.Node = "ground";
        config.Domain = 7;
        config.Interfaces = {"wlan0"};
        counters.DiscoveryBytes = 1000;
    }

    // Returns the problem of a node that listens since second 100; empty if it has none.
    std::string ReasonAt(std::chrono::nanoseconds now) const
    {
        const auto problem = Loneliness::Look(
            config, peers, counters, [this] { return programs; }, 100s, now);
        return problem ? problem->subject + ": " + problem->reason : "";
    }

    GatewayConfig config;
    TransportCounters counters;
    bool programs = false;
    PeerTable peers{"ground", 1};
};

TEST_F(LonelinessTest, SaysWhereItListensAndWhatGoesOutWhenNobodyWasHeardForTenSeconds)
{
    EXPECT_EQ(ReasonAt(109900ms), "");
    EXPECT_EQ(ReasonAt(110s),
              "network: nobody heard in domain 7 on wlan0 for 10 s; multicast goes out; peers: none "
              "(docs/how_to/connect.md)");
}

TEST_F(LonelinessTest, SaysTheSameHoweverLongItLasts)
{
    EXPECT_EQ(ReasonAt(110s), ReasonAt(3600s));
}

TEST_F(LonelinessTest, NamesThePeersThatAreListed)
{
    config.Interfaces = {};
    config.Multicast = false;
    config.Peers = {"10.0.0.2", "uav2.local"};
    EXPECT_THAT(ReasonAt(130s), HasSubstr("on all interfaces for 10 s; multicast is off; peers: 10.0.0.2, "
                                          "uav2.local ("));
}

TEST_F(LonelinessTest, NamesWhatSharedMemoryNeeds)
{
    config.SharedMemory = true;
    EXPECT_THAT(ReasonAt(110s), HasSubstr("peers: none; shared_memory is on, so a node of this host is heard "
                                          "only if both have the same user and the same /dev/shm (docs"));
}

TEST_F(LonelinessTest, SaysWhomANodeWithKeysHears)
{
    EXPECT_THAT(ReasonAt(110s), Not(HasSubstr("keys")));
    config.Security.emplace();
    EXPECT_THAT(ReasonAt(110s),
                HasSubstr("peers: none; with keys, only nodes of the same fleet are heard (docs"));
}

TEST_F(LonelinessTest, SaysWhenNothingGoesOut)
{
    counters.DiscoveryBytes = 0;
    EXPECT_THAT(ReasonAt(110s), HasSubstr("; nothing goes out; "));
    config.BackendConfig = "vendor.xml";
    EXPECT_THAT(ReasonAt(110s), HasSubstr("; multicast is on; ")) << "not counted then";
}

TEST_F(LonelinessTest, ANodeWhosePartnersAreForeignProgramsIsNotLonely)
{
    programs = true;
    config.Foreign.resize(1);
    EXPECT_EQ(ReasonAt(130s), "");
}

TEST_F(LonelinessTest, ANodeThatWantsOtherNodesSaysThatItHearsOnlyPrograms)
{
    programs = true;
    EXPECT_THAT(ReasonAt(130s), HasSubstr("only programs that are no nodes")) << "it has no foreign topic";
    config.Foreign.resize(1);
    config.Subscribe = {{.Message = "Pose", .Type = "Uav::Pose"}};
    EXPECT_THAT(ReasonAt(130s), HasSubstr("network: only programs that are no nodes heard in domain 7 on "));
}

TEST_F(LonelinessTest, CountsFromTheLastBeatOfANodeThatIsLost)
{
    HeardBeat heard;
    heard.Node = "uav1";
    heard.Incarnation = 5;
    heard.Beat = BeatAt(200s);
    heard.Arrival = 200s;
    peers.OnBeat(heard);
    EXPECT_EQ(ReasonAt(201s), "");
    peers.Advance(209s);
    EXPECT_EQ(ReasonAt(209s), "");
    EXPECT_THAT(ReasonAt(212s), HasSubstr("nobody heard"));
}

// Knows one endpoint.
class OneEndpointSession final : public TransportSession
{
public:
    std::unique_ptr<TransportWriter> CreateWriter(const TopicDescription &, const TopicQos &,
                                                  const std::vector<std::string> &) override
    {
        return nullptr;
    }
    std::unique_ptr<TransportReader> CreateReader(const TopicDescription &, const TopicQos &,
                                                  const std::vector<std::string> &, SampleHandler) override
    {
        return nullptr;
    }
    TransportCounters Counters() const override { return {}; }
    std::vector<std::string> RemoteTopics() const override { return {Endpoint.Topic}; }
    std::vector<RemoteEndpoint> RemoteEndpointsOn(const std::string &topic) const override
    {
        return topic == Endpoint.Topic ? std::vector{Endpoint} : std::vector<RemoteEndpoint>();
    }

    RemoteEndpoint Endpoint{.Topic = "rt/chatter"};
};

TEST(LonelyNode, AnEndpointOfANodeIsNoneOfAProgram)
{
    OneEndpointSession session;
    EXPECT_TRUE(Loneliness::HearsPrograms(session));
    session.Endpoint.Node = "uav1";
    EXPECT_FALSE(Loneliness::HearsPrograms(session));
}

TEST(LonelyNode, IsToldOnceHoweverLongItLastsAndOnceWhenSomebodyComes)
{
    RabitTest::CapturedLog log;
    SimulatedFleet fleet;
    GatewayConfig config;
    config.Node = "uav1";
    fleet.Add(config);
    fleet.RunFor(9s);
    EXPECT_THAT(log.Lines(), IsEmpty());
    fleet.RunFor(2h);
    EXPECT_THAT(log.Lines(), ElementsAre(HasSubstr("nobody heard in domain 0 on all interfaces for 10 s; "
                                                   "multicast goes out; peers: none")));
    config.Node = "uav2";
    fleet.Add(config);
    fleet.RunFor(20s);
    ASSERT_EQ(log.Lines().size(), 2u);
    EXPECT_THAT(log.Lines()[1], HasSubstr("no longer: network: nobody heard"));
}

}  // namespace
}  // namespace Rabit
