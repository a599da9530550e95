#include "RadioWatch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace
{
using namespace std::chrono_literals;
using testing::IsEmpty;
using testing::SizeIs;

class RadioWatch : public testing::Test
{
protected:
    Rabit::Gateway::Fleet _fleet;
    std::unique_ptr<Ground::RadioWatch> _watch = std::make_unique<Ground::RadioWatch>();
    Ground::RadioWatch::Duration _now = 100s;

    RadioWatch()
    {
        _fleet.incarnation = 7;
        _fleet.air.budget = 5000;
    }
    Rabit::Gateway::PublicationStatus &Publication(const std::string &message)
    {
        for (auto &publication : _fleet.publications)
            if (publication.message == message)
                return publication;
        _fleet.publications.emplace_back().message = message;
        return _fleet.publications.back();
    }
    Rabit::Gateway::LinkStatus &Link(const std::string &node)
    {
        for (auto &link : _fleet.links)
            if (link.node == node)
                return link;
        _fleet.links.emplace_back().node = node;
        _fleet.links.back().queue = "MissionControl";
        return _fleet.links.back();
    }
    void Post(const std::string &message, std::uint64_t offered, std::uint64_t replaced)
    {
        Publication(message).offered += offered;
        Publication(message).replaced += replaced;
    }
    void Look() { _watch->Look(_fleet, _now); }
    // Calls `second`, then looks, once a second.
    template <typename Second>
    void Pass(int seconds, Second second)
    {
        for (int i = 0; i < seconds; ++i)
        {
            second();
            _now += 1s;
            Look();
        }
    }
    const Ground::RadioUse &Use() const { return _watch->Use(); }
};

TEST_F(RadioWatch, KnowsNothingBeforeTheFirstFleet)
{
    EXPECT_FALSE(Use().Known);
}

TEST_F(RadioWatch, TellsWhatLimitsTheRadioAtOnce)
{
    Look();
    EXPECT_TRUE(Use().Known);
    EXPECT_TRUE(Use().IsLimited());
    EXPECT_EQ(Use().Air.budget, 5000);
}

TEST_F(RadioWatch, TellsOfAStreamHowManyWerePostedAndSent)
{
    Look();
    Pass(5, [this] { Post("Pose", 10, 4); });
    ASSERT_THAT(Use().Streams, SizeIs(1));
    EXPECT_EQ(Use().Streams[0].Message, "Pose");
    EXPECT_DOUBLE_EQ(Use().Streams[0].PostedPerS, 10);
    EXPECT_DOUBLE_EQ(Use().Streams[0].SentPerS, 6);
    EXPECT_DOUBLE_EQ(Use().PostsHeldPerS, 4);
}

TEST_F(RadioWatch, TellsNothingOfAStreamBeforeASecondHasPassed)
{
    Look();
    Post("Pose", 10, 4);
    _now += 900ms;
    Look();
    EXPECT_THAT(Use().Streams, IsEmpty());
}

TEST_F(RadioWatch, DoesNotCallAStreamHeldBackThatIsReplacedNowAndThen)
{
    Look();
    Pass(5, [this] { Post("Pose", 100, 9); });
    EXPECT_THAT(Use().Streams, IsEmpty());
}

TEST_F(RadioWatch, DoesNotCallAStreamHeldBackWhereNothingLimitsTheRadio)
{
    _fleet.air.budget = 0;
    Look();
    Pass(5, [this] { Post("Pose", 10, 4); });
    EXPECT_THAT(Use().Streams, IsEmpty());
    _fleet.air.capacity = 3000;
    Pass(1, [this] { Post("Pose", 10, 4); });
    EXPECT_THAT(Use().Streams, SizeIs(1));
}

TEST_F(RadioWatch, DoesNotCallAStreamHeldBackThatTheConfigurationSlows)
{
    _watch = std::make_unique<Ground::RadioWatch>(Ground::RateLimits{{"Pose", 10}});
    Look();
    Pass(5, [this] { Post("Pose", 100, 90); });
    EXPECT_THAT(Use().Streams, IsEmpty());
    Pass(6, [this] { Post("Pose", 100, 97); });
    ASSERT_THAT(Use().Streams, SizeIs(1));
    EXPECT_DOUBLE_EQ(Use().Streams[0].PostedPerS, 100);
    EXPECT_DOUBLE_EQ(Use().Streams[0].SentPerS, 3);
    EXPECT_DOUBLE_EQ(Use().PostsHeldPerS, 7);
}

TEST_F(RadioWatch, PutsTheStreamsThatAreHeldBackMostFirst)
{
    Look();
    Pass(5,
         [this]
         {
             Post("A", 10, 2);
             Post("B", 50, 40);
         });
    ASSERT_THAT(Use().Streams, SizeIs(2));
    EXPECT_EQ(Use().Streams[0].Message, "B");
}

TEST_F(RadioWatch, ForgetsWithinSecondsThatAStreamWasHeldBack)
{
    Look();
    Pass(20, [this] { Post("Pose", 10, 4); });
    Pass(6, [this] { Post("Pose", 10, 0); });
    EXPECT_THAT(Use().Streams, IsEmpty());
}

TEST_F(RadioWatch, CountsOnWhenFleetsComeQuickly)
{
    Look();
    for (int i = 0; i < 500; ++i)
    {
        _now += 10ms;
        if (i % 10 == 9)
            Post("Pose", 1, i % 20 == 9 ? 1 : 0);
        Look();
        Look();
    }
    ASSERT_THAT(Use().Streams, SizeIs(1));
    EXPECT_NEAR(Use().Streams[0].PostedPerS, 10, 0.5);
    EXPECT_NEAR(Use().Streams[0].SentPerS, 5, 0.5);
}

TEST_F(RadioWatch, BeginsAnewWithAnotherLifeOfTheGateway)
{
    Post("Pose", 1'000'000, 1000);
    Look();
    Pass(5, [this] { Post("Pose", 10, 4); });
    _fleet.publications.clear();
    _fleet.incarnation = 8;
    Pass(1, [this] { Post("Pose", 10, 4); });
    EXPECT_THAT(Use().Streams, IsEmpty());
    Pass(1, [this] { Post("Pose", 10, 4); });
    ASSERT_THAT(Use().Streams, SizeIs(1));
    EXPECT_DOUBLE_EQ(Use().Streams[0].PostedPerS, 10);
}

TEST_F(RadioWatch, SurvivesCountersThatFall)
{
    constexpr std::uint64_t largest = std::numeric_limits<std::uint64_t>::max();
    Post("Pose", largest, largest);
    Post("Other", largest, 0);
    Link("uav1").delivered = Link("uav1").expired = largest;
    Look();
    Publication("Pose").offered = Publication("Pose").replaced = Publication("Other").offered = 0;
    Link("uav1").delivered = Link("uav1").expired = 0;
    Pass(3,
         [this]
         {
             Post("Pose", 10, 4);
             Post("Other", 10, 4);
         });
    EXPECT_THAT(Use().Streams, IsEmpty());
    EXPECT_THAT(Use().Links, IsEmpty());
}

TEST_F(RadioWatch, BeginsAnewWhenTimeGoesBack)
{
    Look();
    Pass(3, [this] { Post("Pose", 10, 4); });
    _now -= 60s;
    Look();
    EXPECT_THAT(Use().Streams, IsEmpty());
    Pass(2, [this] { Post("Pose", 10, 4); });
    ASSERT_THAT(Use().Streams, SizeIs(1));
    EXPECT_DOUBLE_EQ(Use().Streams[0].PostedPerS, 10);
}

TEST_F(RadioWatch, ShowsALinkForWhichMessagesWait)
{
    Look();
    Link("uav1").outbox = 3;
    Pass(1, [] {});
    EXPECT_THAT(Use().Links, SizeIs(1)) << "nothing has left it within a second";
    EXPECT_EQ(Use().Links[0].Node, "uav1");
    EXPECT_EQ(Use().Links[0].Queue, "MissionControl");
    EXPECT_EQ(Use().Links[0].Waiting, 3u);
    EXPECT_EQ(Use().MessagesHeld, 3u);
    Link("uav1").outbox = 0;
    Pass(1, [] {});
    EXPECT_THAT(Use().Links, IsEmpty());
}

TEST_F(RadioWatch, DoesNotShowALinkWhoseMessagesAreOnTheirWay)
{
    Look();
    Pass(1, [] {});
    Link("uav1").outbox = 1;
    _now += 300ms;
    Look();
    EXPECT_THAT(Use().Links, IsEmpty()) << "it was just sent";
    Pass(5,
         [this]
         {
             Link("uav1").outbox = 4;
             Link("uav1").delivered += 30;
         });
    EXPECT_THAT(Use().Links, IsEmpty()) << "so many are delivered in an eighth of a second";
}

TEST_F(RadioWatch, ShowsALinkWhoseMessagesExpireForSomeSeconds)
{
    Look();
    Link("uav1");
    Pass(2, [] {});
    Link("uav1").expired = 2;
    Pass(1, [] {});
    ASSERT_THAT(Use().Links, SizeIs(1));
    EXPECT_EQ(Use().Links[0].Expired, 2u);
    EXPECT_EQ(Use().Links[0].Waiting, 0u);
    Pass(7, [] {});
    EXPECT_THAT(Use().Links, IsEmpty());
}

TEST_F(RadioWatch, PutsTheLinkWithMostMessagesFirst)
{
    Look();
    Link("uav1").outbox = 1;
    Link("uav2").outbox = 9;
    Pass(2, [] {});
    ASSERT_THAT(Use().Links, SizeIs(2));
    EXPECT_EQ(Use().Links[0].Node, "uav2");
}

TEST_F(RadioWatch, ShowsWaitingMessagesWhereNothingLimitsTheRadioToo)
{
    _fleet.air.budget = 0;
    Look();
    Link("uav1").outbox = 1;
    Pass(2, [] {});
    EXPECT_THAT(Use().Links, SizeIs(1));
}

TEST_F(RadioWatch, TakesNoNumberForNoLimit)
{
    _fleet.air.budget = _fleet.air.capacity = std::numeric_limits<double>::quiet_NaN();
    Look();
    EXPECT_FALSE(Use().IsLimited());
}

}  // namespace
