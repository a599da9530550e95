#include "manager/AgreementDriver.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rabit/ManualClock.h>
#include <rabit/base/Fnv1a.h>
#include <rabit/gateway/GatewayConfig.h>
#include <rabit/gateway/RandomSource.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "agreement/AgreementHub.h"
#include "agreement/AgreementNode.h"
#include "agreement/ClaimMessages.h"
#include "agreement/TableCopy.h"
#include "wire/BeatFormat.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using ::testing::_;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Pair;
using ::testing::SizeIs;

// The agreement of the node uav1. The test says what comes, and sees what is sent.
class DrivenAgreement : public ::testing::Test
{
protected:
    using Frame = std::pair<std::string, std::vector<std::uint8_t>>;

    void SetUp() override
    {
        driver.Serve(clock.Monotonic());
        clock.Advance(3s);  // after a start voters abstain for their lease
        Hear("uav2");
    }
    void Hear(const std::string &node, std::uint64_t table = 0)
    {
        const std::uint32_t group = Fnv1a(settings.Group()).Folded();
        driver.OnBeat({node, 1, AgreementNews{.Group = group, .Table = table}});
    }
    void Come(const std::string &node, const std::vector<std::uint8_t> &datagram)
    {
        std::vector<std::uint8_t> frame{AgreementDriver::FirstByte};
        frame.insert(frame.end(), datagram.begin(), datagram.end());
        driver.OnFrame(node, frame);
    }
    ClaimRequest Renewal() const
    {
        return {.Group = settings.Group(), .Incarnation = 1, .Session = 1, .Renewal = 1};
    }
    std::vector<Frame> Served()
    {
        sent.clear();
        driver.Serve(clock.Monotonic());
        return sent;
    }

    static GatewayConfig ConfigOf(const std::shared_ptr<AgreementHub> &hub)
    {
        GatewayConfig config;
        config.Node = "uav1";
        config.Agreement.emplace().Members = {"uav1", "uav2", "uav3"};
        config.Agreed = hub;
        return config;
    }

    const AgreementSettings settings{.Self = "uav2", .Members = {"uav1", "uav2", "uav3"}};
    ManualClock clock{0.0, 1000s};
    const std::shared_ptr<AgreementHub> hub = std::make_shared<AgreementHub>();
    const GatewayConfig config = ConfigOf(hub);
    const RandomSource random = [] { return 7; };
    std::vector<Frame> sent;
    bool hasRoom = true;
    AgreementDriver driver{
        config,
        clock,
        1,
        {},
        random,
        [] {},
        nullptr,
        {.Send = [this](const std::string &node, std::span<const std::uint8_t> frame)
         { sent.emplace_back(node, std::vector<std::uint8_t>(frame.begin() + 1, frame.end())); },
         .PathTo = [](const std::string &node) { return node == "uav3" ? std::size_t{1} : std::size_t{0}; },
         .HasRoom = [this](const std::string & /*node*/, std::size_t /*bytes*/) { return hasRoom; },
         .GroupOf = [this](const std::string & /*node*/)
         { return std::optional(Fnv1a(settings.Group()).Folded()); }}};
};

// Else another one could get the claim while its holder counts the lease from when it sent the renewal.
TEST_F(DrivenAgreement, CountsALeaseFromWhenItTookTheRenewalThoughTheTurnBeganEarlier)
{
    Come("uav2", EncodeClaimRequest(Renewal()));
    const std::vector<Frame> frames = Served();
    ASSERT_THAT(frames, SizeIs(1));
    const auto opened = DecodeClaimReply(frames.front().second);
    ASSERT_TRUE(opened);
    const std::chrono::nanoseconds began = clock.Monotonic();
    clock.Advance(200ms);
    ClaimRequest request = Renewal();
    request.Renewal = 2;
    request.Book = opened->Book;
    request.Number = 1;
    request.Orders = {{.What = ClaimOrder::Kind::Ask, .Name = "cell"}};
    Come("uav2", EncodeClaimRequest(request));
    driver.Serve(began);
    const auto isGranted = [this](std::chrono::nanoseconds at)
    {
        return hub->With([at](const AgreementNode &node, std::chrono::nanoseconds /*now*/)
                         { return node.Ballots().HolderOf("cell", at).has_value(); });
    };
    const std::chrono::nanoseconds end = began + 200ms + settings.VotersLease();
    EXPECT_TRUE(isGranted(end - 1ns));
    EXPECT_FALSE(isGranted(end));
}

TEST_F(DrivenAgreement, TakesDatagramsOfClaimsFromMembersAlone)
{
    Come("stranger", EncodeClaimRequest(Renewal()));
    EXPECT_EQ(driver.Malformed(), 1u);
    EXPECT_THAT(Served(), IsEmpty());
    Come("uav2", EncodeClaimRequest(Renewal()));
    EXPECT_EQ(driver.Malformed(), 1u);
    EXPECT_THAT(Served(), SizeIs(1));
}

TEST_F(DrivenAgreement, KeepsRoomInItsInboxForTheOtherNodes)
{
    for (int i = 0; i < 10000; ++i)
    {
        Come("uav3", {1, 0});
    }
    EXPECT_GT(driver.Malformed(), 9000u);
    Come("uav2", EncodeClaimRequest(Renewal()));
    EXPECT_THAT(Served(), ElementsAre(Pair("uav2", _)));
}

TEST_F(DrivenAgreement, SendsOneDatagramOfTablesByEachPathInATurnIfThereIsRoom)
{
    EXPECT_EQ(hub->Write([](TableCopy &table) { return table.Raise("sorties", 1); }), "");
    hasRoom = false;
    Hear("uav2", 7);
    Hear("uav3", 7);
    Hear("uav4", 7);
    EXPECT_THAT(Served(), IsEmpty());
    hasRoom = true;
    clock.Advance(10ms);
    EXPECT_THAT(Served(), SizeIs(2));
    clock.Advance(10ms);
    EXPECT_THAT(Served(), SizeIs(1));
    clock.Advance(10ms);
    EXPECT_THAT(Served(), IsEmpty());
}

TEST_F(DrivenAgreement, TellsInABeatWhatHasRoomAndKeepsTheOtherAnswers)
{
    const std::vector<std::uint8_t> renewal{1, 0, 0, 0, 1, 0, 0, 0};
    const std::uint32_t group = Fnv1a(settings.Group()).Folded();
    driver.OnBeat({"uav2", 1, AgreementNews{.Group = group, .Renewal = renewal}});
    driver.OnBeat({"uav3", 1, AgreementNews{.Group = group, .Renewal = renewal}});
    EXPECT_EQ(driver.NewsSize(), BeatFormat::Agreement(0, 2 * AgreementNode::AnswerBytes));
    EXPECT_THAT(driver.News(BeatFormat::Agreement(0, 0)).Answers, IsEmpty());
    EXPECT_THAT(driver.News(BeatFormat::Largest).Answers, SizeIs(2 * AgreementNode::AnswerBytes));
}

TEST_F(DrivenAgreement, TellsNothingMoreAfterItHasLeft)
{
    EXPECT_TRUE(hub->Want("cell", true));
    EXPECT_TRUE(hub->StatusOf("cell").Reason.empty());
    driver.Leave();
    EXPECT_EQ(driver.News(BeatFormat::Largest).Table, 0u);
    EXPECT_EQ(driver.NewsSize(), BeatFormat::Agreement(0, 0));
    Hear("uav2", 7);
    EXPECT_THAT(Served(), IsEmpty());
    EXPECT_TRUE(hub->StatusOf("cell").IsWanted) << "it waits for the next gateway";
}

}  // namespace
}  // namespace Rabit
