// The abstract network, here on the simulated one: what a backend offers, and what a test may break.
#include <gtest/gtest.h>
#include <rabit/simulated/SimulatedKeys.h>
#include <rabit/simulated/SimulatedNetwork.h>
#include <rabit/simulated/SimulatedTransport.h>
#include <rabit/transport/DiscoveryTurns.h>
#include <rabit/transport/FleetMember.h>
#include <rabit/transport/Transport.h>
#include <rabit/transport/TransportFactory.h>
#ifdef RABIT_MANUAL_FASTDDS
#include <rabit/fastdds/FastDdsTransport.h>
#endif
#ifdef RABIT_MANUAL_CYCLONEDDS
#include <rabit/cyclonedds/CycloneDdsTransport.h>
#endif

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace
{

using namespace std::chrono_literals;

// [encoder]
// Fills the buffer of the backend, so that there is one pass over the data.
class Octets : public Rabit::SampleEncoder
{
public:
    std::size_t EncodedSize() const override { return _bytes.size(); }
    bool Encode(std::span<std::uint8_t> buffer) const override
    {
        std::copy(_bytes.begin(), _bytes.end(), buffer.begin());
        return true;
    }

private:
    // Little endian CDR, and four bytes.
    const std::array<std::uint8_t, 8> _bytes = {0, 1, 0, 0, 1, 2, 3, 4};
};
// [/encoder]

// [sessions]
TEST(NetworkExample, ASampleOfOneSessionReachesAnother)
{
    Rabit::SimulatedNetwork network(1);  // a seed
    Rabit::SimulatedTransport transport(network);
    std::vector<std::string> peers;
    Rabit::TransportSettings settings;
    settings.Node = "uav1";
    settings.Incarnation = 1;
    const std::unique_ptr<Rabit::TransportSession> from =
        transport.Open(settings, [](const Rabit::PeerEvent &) {});
    settings.Node = "ground";
    const std::unique_ptr<Rabit::TransportSession> to =
        transport.Open(settings, [&peers](const Rabit::PeerEvent &event) { peers.push_back(event.Node); });

    const Rabit::TopicDescription topic{"Octets", "Test::Octets", {}};
    std::vector<std::string> received;
    const std::unique_ptr<Rabit::TransportWriter> writer = from->CreateWriter(topic, {}, {});
    const std::unique_ptr<Rabit::TransportReader> reader = to->CreateReader(
        topic, {}, {},
        [&received](Rabit::SampleBytes bytes, const Rabit::SampleInfo &info)
        { received.push_back(std::string(info.Node) + ' ' + std::to_string(bytes.size())); });
    network.AdvanceTo(2s);
    EXPECT_EQ(reader->MatchedWriters(), 1);
    EXPECT_EQ(peers, std::vector<std::string>{"uav1"});

    EXPECT_EQ(writer->Write(Octets(), 0), Rabit::WriteResult::Ok);
    network.AdvanceTo(3s);
    EXPECT_EQ(received, std::vector<std::string>{"uav1 8"});
    EXPECT_GT(from->Counters().SampleBytes, 8u);  // with all headers
}
// [/sessions]

// [factory]
TEST(NetworkExample, AProgramChoosesABackendByName)
{
    EXPECT_FALSE(Rabit::AvailableTransports().empty());
    EXPECT_THROW(Rabit::MakeTransport("carrier_pigeon"), Rabit::TransportError);
#ifdef RABIT_MANUAL_FASTDDS
    const std::unique_ptr<Rabit::Transport> fast = std::make_unique<Rabit::FastDdsTransport>();
    EXPECT_EQ(fast->Name(), "fastdds");
#endif
#ifdef RABIT_MANUAL_CYCLONEDDS
    const std::unique_ptr<Rabit::Transport> cyclone = std::make_unique<Rabit::CycloneDdsTransport>();
    EXPECT_EQ(cyclone->Name(), "cyclonedds");
#endif
}
// [/factory]

// [member]
TEST(NetworkExample, AMemberOfAFleetNeedsKeysThatBelongTogether)
{
    const Rabit::MemberKeys keys{};  // the content of a key folder; here, nothing
    Rabit::MadeMember made = Rabit::MakeFleetMember(keys);
    EXPECT_EQ(made.Error, "the certificate is damaged");
    EXPECT_EQ(made.Member, nullptr);

    // A test makes keys in memory. One member serves all sessions of a node.
    Rabit::SimulatedNetwork network(1);
    Rabit::SimulatedKeys fleet(network);
    const std::shared_ptr<Rabit::FleetMember> member = fleet.Member("uav1");
    Rabit::TransportSettings settings;
    settings.Node = "uav1";
    settings.Incarnation = 1;
    settings.Member = member;
    const std::unique_ptr<Rabit::TransportSession> session =
        Rabit::SimulatedTransport(network).Open(settings, [](const Rabit::PeerEvent &) {});
    EXPECT_TRUE(member->Problems().empty());
}
// [/member]

// [turns]
// Discovery that sends when the holder of the session lets it.
class OneDatagram : public Rabit::DiscoveryTurns::Exchange
{
public:
    std::size_t NextBytes() override { return Sent == 0 ? 300 : 0; }
    void SendNext() override { ++Sent; }
    std::chrono::nanoseconds QueueingDelay() const override { return 0ns; }
    int Sent = 0;
};

TEST(NetworkExample, DiscoveryWaitsForItsTurn)
{
    Rabit::DiscoveryTurns turns;
    OneDatagram exchange;
    int woken = 0;
    turns.Schedule([&woken] { ++woken; });
    turns.SetExchange(exchange);
    turns.Due();
    EXPECT_EQ(woken, 1);
    while (turns.IsDue() && turns.NextBytes() > 0)
    {
        turns.SendNext();
    }
    EXPECT_EQ(exchange.Sent, 1);
    turns.RemoveExchange(exchange);
}
// [/turns]

}  // namespace
