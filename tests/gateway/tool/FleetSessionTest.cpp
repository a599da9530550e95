// When a session of the tool ends its waits: beside a node over each real backend, on loopback. Beats of the
// node come seldom, so no wait ends by itself while a test runs.
#include "FleetSession.h"

#include <gtest/gtest.h>
#include <rabit/transport/TransportFactory.h>

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "../../Eventually.h"
#include "../BeatSamples.h"
#include "../MessageSample.h"
#include "DomainLease.h"
#include "names/NodeTag.h"
#include "wire/BeatExtensions.h"

namespace Rabit::Tool
{
namespace
{

// Twice this time after its start a session has heard everybody: longer than any test takes.
constexpr std::uint16_t Period = 60'000;  // ms
constexpr double Everybody = 120.0;       // s

// A node whose beats the test writes.
class WrittenNode
{
public:
    explicit WrittenNode(const std::string &transport, const std::string &name = "uav1")
        : _name(name), _transport(MakeTransport(transport))
    {
        TransportSettings settings;
        settings.Node = name;
        settings.Incarnation = 1;
        settings.Domain = Conformance::OwnDomain();
        settings.Interfaces = {"lo"};
        _session = _transport->Open(settings, [](const PeerEvent &) {});
        TopicQos qos;
        qos.Reliability = Reliability::BestEffort;
        _writer = _session->CreateWriter({"rabit/Beat", "Rabit::Gateway::Beat", {}}, qos, {});
    }

    std::uint32_t Tag() const { return NodeTagOf(_name, 1); }
    void Beat(std::uint32_t fleetSum)
    {
        const auto now = std::chrono::steady_clock::now().time_since_epoch();
        Gateway::Beat beat = BeatAt(now);
        beat.next_ms = Period;
        BeatExtensions::SayFleetSum(beat, fleetSum);
        EXPECT_EQ(_writer->Write(MessageSample(beat), now.count()), WriteResult::Ok);
    }

private:
    const std::string _name;
    std::unique_ptr<Transport> _transport;
    std::unique_ptr<TransportSession> _session;
    std::unique_ptr<TransportWriter> _writer;
};

class FleetSessionTest : public ::testing::TestWithParam<std::string>
{
protected:
    FleetSessionTest()
    {
        options.Node.Domain = Conformance::OwnDomain();
        options.Node.Transport = GetParam();
        options.Interfaces = {"lo"};
        options.Wait = 2.0 * Everybody;
        session = std::make_unique<FleetSession>(ConfigOf(options), options, wakeup);
    }

    // Has the node tell that sum until the session knows, or does not know, the whole fleet by it.
    void Hear(std::uint32_t fleetSum, bool isKnown)
    {
        const auto isSo = [&]
        {
            node.Beat(fleetSum);
            return session->IsAnybodyThere() && session->IsFleetKnown() == isKnown;
        };
        ASSERT_TRUE(RabitTest::Eventually(isSo));
    }
    static bool Never() { return false; }

    Wakeup wakeup;  // before any thread
    WrittenNode node{GetParam()};
    CommonOptions options;
    std::unique_ptr<FleetSession> session;
};

TEST_P(FleetSessionTest, EndsItsWaitForANodeThatNoOtherHearsEither)
{
    Hear(node.Tag(), true);
    EXPECT_TRUE(session->IsEverybodyHeard());
    EXPECT_FALSE(session->WaitForOffers("uav9", Never));
    EXPECT_LT(session->Seconds(), Everybody);
}

TEST_P(FleetSessionTest, ListsNodesInTheirNaturalOrder)
{
    WrittenNode tenth(GetParam(), "uav10");
    WrittenNode second(GetParam(), "uav2");
    ASSERT_TRUE(RabitTest::Eventually(
        [&]
        {
            for (WrittenNode *one : {&node, &tenth, &second})
            {
                one->Beat(0);
            }
            return session->Nodes().size() == 3 && session->Fleet().nodes.size() == 3;
        }));
    std::vector<std::string> nodes;
    for (const FleetSession::Node &one : session->Nodes())
    {
        nodes.push_back(one.Name);
    }
    std::vector<std::string> fleet;
    for (const Gateway::NodeStatus &one : session->Fleet().nodes)
    {
        fleet.push_back(one.node);
    }
    EXPECT_EQ(nodes, (std::vector<std::string>{"uav1", "uav2", "uav10"}));
    EXPECT_EQ(fleet, nodes);
}

TEST_P(FleetSessionTest, WaitsForANodeThatAnotherOneHears)
{
    Hear(node.Tag() + 9, false);
    EXPECT_FALSE(session->IsEverybodyHeard());
    options.Wait = session->Seconds() + 0.3;
    EXPECT_FALSE(session->WaitForOffers("uav9", Never));
    EXPECT_GE(session->Seconds(), options.Wait);
}

TEST_P(FleetSessionTest, WaitsForNodesThatAreYetToComeIfTheUserAsksForIt)
{
    Hear(node.Tag(), true);
    options.Wait = session->Seconds() + 0.3;
    options.IsWaitGiven = true;
    EXPECT_FALSE(session->WaitForOffers("uav9", Never));
    EXPECT_GE(session->Seconds(), options.Wait);
}

INSTANTIATE_TEST_SUITE_P(Backends, FleetSessionTest, ::testing::ValuesIn(AvailableTransports()),
                         [](const auto &backend) { return backend.param; });

}  // namespace
}  // namespace Rabit::Tool
