// How large a frame of the links may be, over each real backend, on loopback.
#include <gtest/gtest.h>
#include <rabit/gateway/links/LinkMessages.h>
#include <rabit/transport/TransportFactory.h>

#include <algorithm>
#include <memory>
#include <string>

#include "../Eventually.h"
#include "DomainLease.h"
#include "wire/LinkTopics.h"

namespace Rabit
{
namespace
{

// A sample of this many bytes.
class Filled final : public SampleEncoder
{
public:
    explicit Filled(std::size_t size) : _size(size) {}
    std::size_t EncodedSize() const override { return _size; }
    bool Encode(std::span<std::uint8_t> buffer) const override
    {
        std::fill(buffer.begin(), buffer.end(), std::uint8_t{0});
        return true;
    }

private:
    const std::size_t _size;
};

std::unique_ptr<TransportSession> Open(Transport &transport, const std::string &node, std::size_t datagram)
{
    TransportSettings settings;
    settings.Node = node;
    settings.Incarnation = 1;
    settings.Domain = Conformance::OwnDomain();
    settings.Interfaces = {"127.0.0.1"};
    settings.MaxDatagram = datagram;
    return transport.Open(settings, [](const PeerEvent &) {});
}

class RealLinkDatagramTest : public ::testing::TestWithParam<std::string>
{
};

TEST_P(RealLinkDatagramTest, TheLargestFrameIsOneDatagram)
{
    for (const std::size_t datagram : {TransportSettings::SmallestDatagram, std::size_t{1400}})
    {
        const auto transport = MakeTransport(GetParam());
        const auto first = Open(*transport, "uav1", datagram);
        const auto second = Open(*transport, "ground", datagram);
        const auto reader = second->CreateReader(DescribeLinkTopic(), LinkTopicQos(), {},
                                                 [](SampleBytes, const SampleInfo &) {});
        const auto writer = first->CreateWriter(DescribeLinkTopic(), LinkTopicQos(), {});
        ASSERT_TRUE(RabitTest::Eventually([&] { return writer->MatchedReaders() == 1; }));
        const TransportCounters before = first->Counters();
        const Filled sample(LargestLinkFrame(datagram) + LinkSampleOverhead);
        ASSERT_EQ(writer->WriteTo("ground", sample, 1), WriteResult::Ok);
        EXPECT_EQ(first->Counters().SampleDatagrams - before.SampleDatagrams, 1u) << datagram;
        EXPECT_GE(LargestLinkFrame(datagram), datagram * 8 / 10);
    }
}

INSTANTIATE_TEST_SUITE_P(Backends, RealLinkDatagramTest, ::testing::ValuesIn(AvailableTransports()));

}  // namespace
}  // namespace Rabit
