// How often a reader sends its request to a writer that does not answer.
#include "RequestPace.h"

#include <gtest/gtest.h>

#include <vector>

#include "guard/DeliveryCheck.h"
#include "guard/RtpsBytes.h"

namespace
{

using namespace RtpsBytes;
using namespace std::chrono_literals;
using Rabit::FastDds::FirstRequest;
using Rabit::FastDds::RequestPace;

class RequestPaceTest : public testing::Test
{
protected:
    // Requests as often as the vendor does. Returns the times at which the request goes, in ms from the
    // start.
    std::vector<int> Ask(int from, int to, int step, const FirstRequest &request)
    {
        std::vector<int> sent;
        for (int at = from; at < to; at += step)
        {
            if (Pace.MayGo(1, request, Start + std::chrono::milliseconds(at)))
            {
                sent.push_back(at);
            }
        }
        return sent;
    }

    RequestPace Pace;
    RequestPace::TimePoint Start{1h};
    const FirstRequest First{Sender, UserReader, UserWriter};
    const FirstRequest Second{Other, UserReader, UserWriter};
};

TEST_F(RequestPaceTest, RepetitionsFollowEachOtherAtDoublingDistances)
{
    EXPECT_EQ(Ask(0, 10000, 10, First), (std::vector{0, 50, 150, 350, 750, 1550, 3150, 5150, 7150, 9150}));
}

TEST_F(RequestPaceTest, DiscoveryIsAskedOnlyIfItDoesNotSpeakByItself)
{
    const FirstRequest publications{Sender, 0x000003c7, Rabit::Rtps::PublicationsWriter};
    EXPECT_EQ(Ask(0, 1000, 70, publications), (std::vector{140, 210, 350, 560, 980}));
    EXPECT_EQ(Ask(10000, 10100, 70, publications), std::vector<int>());
}

TEST_F(RequestPaceTest, OneDoesNotHoldUpAnother)
{
    Ask(0, 1000, 10, First);
    EXPECT_EQ(Ask(1000, 1001, 10, Second), std::vector{1000});
}

TEST_F(RequestPaceTest, WhatGoesByOneSocketGoesByTheOthersToo)
{
    EXPECT_TRUE(Pace.MayGo(1, First, Start));
    EXPECT_TRUE(Pace.MayGo(2, First, Start));
    EXPECT_FALSE(Pace.MayGo(2, First, Start + 10ms));
}

TEST_F(RequestPaceTest, WhoHadStoppedAsksAnew)
{
    Ask(0, 5000, 10, First);
    EXPECT_EQ(Ask(7000, 7100, 10, First), (std::vector{7000, 7050}));
}

TEST_F(RequestPaceTest, PeersWithoutEndDoNotFillTheMemory)
{
    FirstRequest request = Second;
    for (std::size_t i = 0; i < 3 * RequestPace::MostRequests; ++i)
    {
        request.Reader = static_cast<Rabit::Rtps::EntityId>(i);
        EXPECT_TRUE(Pace.MayGo(1, request, Start));
    }
    EXPECT_LE(Pace.Size(), RequestPace::MostRequests);
}

}  // namespace
