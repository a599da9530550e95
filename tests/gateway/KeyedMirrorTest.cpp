// A published message whose key changes, as nodes and as plain programs see it, on the simulated network.
#include <gmock/gmock.h>
#include <rabit/idl/MessageType.h>

#include <map>

#include "SimulatedFleet.h"
#include "keyed.idl.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using GatewayTest::Contact;
using testing::ElementsAre;
using testing::Pair;

// A program that reads the topic and is no node. Keeps the instances as it sees them: alive or not.
class PlainReader
{
public:
    PlainReader(SimulatedNetwork &network, const std::string &name)
    {
        TransportSettings settings;
        settings.Node = name;
        settings.Incarnation = 1;
        _session = SimulatedTransport(network).Open(settings, [](const PeerEvent &) {});
        TopicQos qos;
        qos.Durability = Durability::TransientLocal;
        const auto keyOf = [](SampleBytes bytes, KeyHash &key)
        { return Contact::IdlType().KeyHashOf(bytes, key); };
        _reader = _session->CreateReader({"Contact", "GatewayTest::Contact", keyOf}, qos, {},
                                         [this](SampleBytes, const SampleInfo &info)
                                         { Instances[info.Key[3]] = info.Alive; });
    }

    std::map<int, bool> Instances;

private:
    std::unique_ptr<TransportSession> _session;
    std::unique_ptr<TransportReader> _reader;
};

class KeyedMirrorTest : public testing::Test
{
protected:
    KeyedMirrorTest()
    {
        GatewayConfig aircraft;
        aircraft.Node = "uav1";
        aircraft.Publish.push_back({.Message = "Contact", .Type = "GatewayTest::Contact"});
        GatewayConfig station;
        station.Node = "ground";
        station.Subscribe.push_back({.Message = "Contact", .Type = "GatewayTest::Contact", .From = {"*"}});
        uav = &fleet.Add(aircraft);
        ground = &fleet.Add(station);
        contact = uav->Register<Contact>("Contact");
        mirrored = ground->Register<Contact>("uav1/Contact");
    }

    void Post(std::uint32_t number)
    {
        contact->number = number;
        contact->PostMessage();
    }

    SimulatedFleet fleet;
    SimulatedNode *uav = nullptr;
    SimulatedNode *ground = nullptr;
    std::shared_ptr<Contact> contact;
    std::shared_ptr<Contact> mirrored;
};

TEST_F(KeyedMirrorTest, APlainReaderIsToldThatTheFormerInstanceIsGoneAndALateOneHearsOfTheNewestAlone)
{
    PlainReader early(fleet.Network, "early");
    fleet.RunFor(3s);
    for (std::uint32_t number = 1; number <= 3; ++number)
    {
        Post(number);
        fleet.RunFor(100ms);
    }
    EXPECT_THAT(early.Instances, ElementsAre(Pair(1, false), Pair(2, false), Pair(3, true)));
    PlainReader late(fleet.Network, "late");
    fleet.RunFor(1s);
    EXPECT_THAT(late.Instances, ElementsAre(Pair(3, true)));
    mirrored->FetchMessage();
    EXPECT_EQ(mirrored->number, 3u);
}

TEST_F(KeyedMirrorTest, AMessageThatIsRepeatedIsNotDisposed)
{
    PlainReader early(fleet.Network, "early");
    fleet.RunFor(3s);
    Post(9);
    fleet.RunFor(5s);
    Post(9);
    fleet.RunFor(5s);
    EXPECT_THAT(early.Instances, ElementsAre(Pair(9, true)));
}

TEST_F(KeyedMirrorTest, OnANetworkThatLosesAndReordersTheNewestInstanceIsTheOneThatIsLeft)
{
    PlainReader early(fleet.Network, "early");
    SimulatedFaults bad;
    bad.Loss = 0.3;
    bad.Duplicate = 0.1;
    bad.Jitter = 30ms;
    fleet.Network.SetFaults("*", "*", bad);
    fleet.RunFor(10s);
    for (std::uint32_t number = 1; number <= 100; ++number)
    {
        Post(number % 7);
        fleet.RunFor(20ms);
    }
    fleet.RunFor(5s);
    mirrored->FetchMessage();
    EXPECT_EQ(mirrored->number, 100u % 7);
    for (const auto &[number, alive] : early.Instances)
    {
        EXPECT_EQ(alive, number == 100 % 7) << number;
    }
    EXPECT_TRUE(early.Instances.contains(100 % 7));
    PlainReader late(fleet.Network, "late");
    ASSERT_TRUE(fleet.RunUntil([&] { return !late.Instances.empty(); }, 20s));
    fleet.RunFor(5s);
    EXPECT_THAT(late.Instances, ElementsAre(Pair(100 % 7, true)));
}

}  // namespace
}  // namespace Rabit
