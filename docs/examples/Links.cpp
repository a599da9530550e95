// The protocol of queue links by itself: two state machines, and a network that is a few lines of a test.
#include <gtest/gtest.h>
#include <rabit/gateway/links/LinkCheck.h>
#include <rabit/gateway/links/LinkCounters.h>
#include <rabit/gateway/links/LinkFrameCodec.h>
#include <rabit/gateway/links/LinkHost.h>
#include <rabit/gateway/links/LinkMessages.h>
#include <rabit/gateway/links/LinkNode.h>
#include <rabit/gateway/links/LinkOptions.h>
#include <rabit/gateway/links/LinkOutcome.h>
#include <rabit/gateway/links/LinkPayload.h>
#include <rabit/gateway/links/LinkTime.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

namespace
{

using namespace std::chrono_literals;

// [host]
// What a link node needs of its driver: somewhere to send, local queues, and numbers of incarnations.
class Host : public Rabit::LinkOutput, public Rabit::LocalQueues, public Rabit::IncarnationSource
{
public:
    void Send(const Rabit::LinkFrame &frame, std::string_view) override
    {
        std::vector<std::uint8_t> bytes(Rabit::LinkFrameCodec::EncodedSize(frame));
        Rabit::LinkFrameCodec::Encode(frame, bytes);
        Sent.push_back(std::move(bytes));
    }
    void OnOutcome(std::uint64_t, std::string_view, std::string_view, Rabit::LinkOutcome outcome) override
    {
        Outcomes.emplace_back(ToString(outcome));
    }

    bool Accepts(std::string_view, std::string_view queue) override { return queue == "Mission"; }
    bool AcceptsType(std::string_view, std::string_view) const override { return true; }
    Rabit::LocalQueueResult Deliver(const Rabit::LinkDelivery &delivery) override
    {
        Queue.push_back(std::string(delivery.Source) + ' ' + std::string(delivery.Type));
        return Rabit::LocalQueueResult::Ok;
    }
    std::size_t Room(std::string_view) const override { return 100; }

    std::uint64_t Above(std::uint64_t floor) override { return floor + 1; }

    std::deque<std::vector<std::uint8_t>> Sent;
    std::vector<std::string> Outcomes;
    std::vector<std::string> Queue;
};
// [/host]

// Hands what one has sent to the other.
void Carry(Host &from, const std::string &source, Rabit::LinkNode &to, Rabit::LinkTime now)
{
    while (!from.Sent.empty())
    {
        const std::vector<std::uint8_t> bytes = from.Sent.front();
        from.Sent.pop_front();
        Rabit::LinkFrame frame;
        ASSERT_TRUE(Rabit::LinkFrameCodec::Decode(bytes, frame));
        frame.Source = source;
        frame.Destination = to.Name();
        to.OnFrame(frame, now);
    }
}

// [links]
TEST(LinksExample, AMessageReachesTheQueueOfAnotherNode)
{
    Host ground;
    Host uav;
    Rabit::LinkSettings settings;
    settings.Node = "ground";
    settings.Clock = 1;
    Rabit::LinkNode from(settings, ground, ground, ground);
    settings.Node = "uav1";
    settings.Clock = 2;
    Rabit::LinkNode to(settings, uav, uav, uav);

    Rabit::LinkTime now = 1s;
    from.Configure("uav1", "Mission", {.Expire = 5s}, now);
    const std::array<std::uint8_t, 4> bytes = {0, 1, 0, 0};
    const Rabit::LinkEnqueued enqueued =
        from.Enqueue("uav1", "Mission", "Uav::GoHome", Rabit::LinkBytes::CopyOf(bytes), now);
    EXPECT_TRUE(enqueued.Accepted());
    for (; ground.Outcomes.empty() && now < 10s; now += 10ms)
    {
        from.Run(now);
        Carry(ground, "ground", to, now);
        to.Run(now);
        Carry(uav, "uav1", from, now);
    }

    EXPECT_EQ(uav.Queue, std::vector<std::string>{"ground Uav::GoHome"});
    EXPECT_EQ(ground.Outcomes, std::vector<std::string>{"delivered"});
    from.VisitSenders([](std::string_view, std::string_view, const Rabit::LinkSenderCounters &counters)
                      { EXPECT_EQ(counters.Delivered, 1u); });
    EXPECT_NE(Rabit::LinkCheck::OfName("uav1"), Rabit::LinkCheck::OfName("uav2"));
}
// [/links]

}  // namespace
