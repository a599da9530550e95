// In the steady state a link allocates nothing for a message. A program of its own, because it replaces
// operator new.
#include <gtest/gtest.h>
#include <rabit/gateway/links/LinkFrameCodec.h>
#include <rabit/gateway/links/LinkNode.h>

#include <algorithm>

#include "../../bench/common/Usage.h"

namespace Rabit::Test
{
namespace
{

using namespace std::chrono_literals;

// A node that passes its frames straight to the other one.
class Wired : public LinkOutput, public LocalQueues, public IncarnationSource
{
public:
    explicit Wired(const char *name, std::uint64_t clock)
    {
        LinkSettings settings;
        settings.Node = name;
        settings.Clock = clock;
        Node = std::make_unique<LinkNode>(settings, *this, *this, *this);
    }
    void Send(const LinkFrame &frame, std::string_view) override
    {
        // Encodes and decodes like the real path, but in reused memory.
        _bytes.resize(std::max(_bytes.size(), LinkFrameCodec::EncodedSize(frame)));
        const std::span<std::uint8_t> bytes = std::span(_bytes).first(LinkFrameCodec::EncodedSize(frame));
        LinkFrameCodec::Encode(frame, bytes);
        ASSERT_TRUE(LinkFrameCodec::Decode(bytes, _frame));
        _frame.Source = Node->Name();
        Other->Node->OnFrame(_frame, *Now);
    }
    void OnOutcome(std::uint64_t, std::string_view, std::string_view, LinkOutcome) override { ++Outcomes; }
    bool Accepts(std::string_view, std::string_view) override { return true; }
    bool AcceptsType(std::string_view, std::string_view) const override { return true; }
    LocalQueueResult Deliver(const LinkDelivery &) override { return LocalQueueResult::Ok; }
    std::size_t Room(std::string_view) const override { return 1000; }
    std::uint64_t Above(std::uint64_t floor) override { return floor + (1ULL << 32); }

    std::unique_ptr<LinkNode> Node;
    Wired *Other = nullptr;
    const LinkTime *Now = nullptr;
    std::size_t Outcomes = 0;

private:
    std::vector<std::uint8_t> _bytes;
    LinkFrame _frame;
};

TEST(LinkAllocation, AMessageInTheSteadyStateCostsNone)
{
    LinkTime now = 1s;
    Wired a("a", 1);
    Wired b("b", 2);
    a.Other = &b;
    b.Other = &a;
    a.Now = b.Now = &now;
    const LinkPayload payload = std::make_shared<const LinkBytes>(100);
    const auto exchange = [&](int messages)
    {
        for (int i = 0; i < messages; ++i)
        {
            a.Node->Enqueue("b", "a queue with a long name", "A::Type::With::A::Long::Name", payload, now);
            a.Node->Enqueue("b", "a queue with a long name", "A::Type::With::A::Long::Name", payload, now);
            a.Node->Run(now);
            now += 3ms;
            b.Node->Run(now);
        }
    };
    exchange(1000);
    const std::uint64_t before = Bench::AllocationsSoFar();
    exchange(10000);
    EXPECT_EQ(Bench::AllocationsSoFar(), before);
    EXPECT_EQ(a.Outcomes, 22000U);
}

}  // namespace
}  // namespace Rabit::Test
