// The throughput and delay of links on thin and lossy media, in virtual time: exact, and the same each
// time.
#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "ThinMedium.h"

namespace Rabit::Test
{
namespace
{

using namespace std::chrono_literals;

double Seconds(LinkTime time)
{
    return std::chrono::duration<double>(time).count();
}

// Keeps the link filled for `time`.
void Feed(ThinMedium &medium, LinkTime time)
{
    for (const LinkTime end = medium.Now + time; medium.Now < end;)
    {
        while (medium.A.Enqueue("beta", "q", 100000))
        {
        }
        medium.Live(std::min<LinkTime>(500ms, end - medium.Now));
    }
}

void FeedSmall(ThinMedium &medium, LinkTime time)
{
    for (const LinkTime end = medium.Now + time; medium.Now < end;)
    {
        while (medium.A.Enqueue("beta", "q", 1000))
        {
        }
        medium.Live(std::min<LinkTime>(10ms, end - medium.Now));
    }
}

// Returns the time until three pictures have arrived.
LinkTime TimeOfThreePictures(ThinMedium &medium)
{
    medium.BitsPerSecond = 250e3;
    const LinkTime start = medium.Now;
    for (int i = 0; i < 3; ++i)
    {
        EXPECT_TRUE(medium.A.Enqueue("beta", "q", 200000));
    }
    while (medium.B.DeliveredBytes < 600000 && medium.Step(start + 60s))
    {
    }
    EXPECT_EQ(medium.B.DeliveredBytes, 600000U);
    return medium.Now - start;
}

TEST(ThinMedium, ThreePicturesAt250KbitTakeWhatTheMediumTakes)
{
    ThinMedium medium;
    const LinkTime took = TimeOfThreePictures(medium);
    EXPECT_LE(static_cast<double>(medium.BytesSent), 1.15 * 600000)
        << "all headers and acknowledgements included";
    const double possible = static_cast<double>(medium.BytesSent) * 8 / 250e3;
    EXPECT_LE(Seconds(took), possible * 1.02) << "the medium is used up";
    EXPECT_LE(medium.LongestWait, 300ms);
}

// Measures the overhead of the protocol alone: the pictures take 19.2 s.
TEST(ThinMedium, ThreePicturesWhoseHeadersCostNothingTake21SecondsAtMost)
{
    ThinMedium medium(0);
    EXPECT_LE(TimeOfThreePictures(medium), 21s);
    EXPECT_LE(medium.LongestWait, 300ms);
}

TEST(ThinMedium, ThirtyMessagesOf500BytesASecondArriveWithinTwoSecondsAt250Kbit)
{
    ThinMedium medium;
    medium.BitsPerSecond = 250e3;
    LinkOptions options;
    options.Expire = 2s;
    medium.A.Node->Configure("beta", "q", options, medium.Now);
    for (int i = 0; i < 1000; ++i)
    {
        medium.A.Enqueue("beta", "q", 500);
        medium.Live(33333us);
    }
    medium.Live(3s);
    EXPECT_EQ(medium.A.Outcomes[static_cast<std::size_t>(LinkOutcome::Delivered)], 1000U);
    EXPECT_LE(medium.B.Percentile("q", 0.99), 100ms);
}

struct Loss
{
    double Part;
    int PerSecond;
    LinkTime P99;
};

class LossTest : public ::testing::TestWithParam<Loss>
{
};

TEST_P(LossTest, CommandsAreDeliveredSoon)
{
    ThinMedium medium;
    medium.Loss = GetParam().Part;
    medium.Delay = 1ms;
    int refused = 0;
    for (int i = 0; i < 20 * GetParam().PerSecond; ++i)
    {
        refused += medium.A.Enqueue("beta", "q", 32) ? 0 : 1;
        medium.Live(LinkTime(1s) / GetParam().PerSecond);
    }
    medium.Live(10s);
    EXPECT_EQ(refused, 0);
    EXPECT_EQ(medium.B.Delays["q"].size(), static_cast<std::size_t>(20 * GetParam().PerSecond));
    EXPECT_LE(medium.B.Percentile("q", 0.99), GetParam().P99);
}

INSTANTIATE_TEST_SUITE_P(ThinMedium, LossTest,
                         ::testing::Values(Loss{0.05, 50, 50ms}, Loss{0.2, 10, 150ms}, Loss{0.2, 50, 150ms},
                                           Loss{0.2, 200, 150ms}, Loss{0.2, 500, 150ms},
                                           Loss{0.4, 50, 600ms}));

TEST(ThinMedium, ASatellitesRoundTripLeavesMostOfTheMediumUsable)
{
    for (const double rate : {250e3, 1e6})
    {
        ThinMedium medium;
        medium.BitsPerSecond = rate;
        medium.Delay = 300ms;
        Feed(medium, 20s);
        medium.BytesCarried = 0;
        Feed(medium, 120s);
        EXPECT_GE(static_cast<double>(medium.BytesCarried) * 8, 0.7 * rate * 120) << rate;
    }
}

// The number of messages that may be under way limits the link, not the window. Sent in bursts, as the
// window allows, they would overflow the buffer and then leave it empty.
TEST(ThinMedium, SmallMessagesOnAFarAndWideMediumAreSpreadOverTheRoundTrip)
{
    ThinMedium medium;
    medium.BitsPerSecond = 5e6;
    medium.Delay = 300ms;
    FeedSmall(medium, 20s);
    medium.B.DeliveredBytes = 0;
    medium.Overflows = 0;
    medium.Datagrams = 0;
    FeedSmall(medium, 60s);
    EXPECT_LE(static_cast<double>(medium.Overflows), 0.02 * static_cast<double>(medium.Datagrams));
    EXPECT_GE(static_cast<double>(medium.B.DeliveredBytes) * 8, 0.5 * 5e6 * 60);
}

TEST(ThinMedium, SmallMessagesHaveMostOfWhatASatelliteCarries)
{
    for (const double rate : {250e3, 1e6})
    {
        ThinMedium medium;
        medium.BitsPerSecond = rate;
        medium.Delay = 300ms;
        FeedSmall(medium, 20s);
        medium.B.DeliveredBytes = 0;
        FeedSmall(medium, 120s);
        EXPECT_GE(static_cast<double>(medium.B.DeliveredBytes) * 8, 0.7 * rate * 120) << rate;
    }
}

TEST(ThinMedium, AnIdlePairSaysNothingWhateverTheRoundTrip)
{
    for (const LinkTime delay : {LinkTime(5ms), LinkTime(300ms)})
    {
        ThinMedium medium;
        medium.Delay = delay;
        medium.A.Enqueue("beta", "q", 32);
        medium.B.Enqueue("alpha", "q", 32);
        medium.Live(10s);
        const std::size_t before = medium.Datagrams;
        medium.Live(1h);
        EXPECT_EQ(medium.Datagrams, before);
    }
}

TEST(ThinMedium, AMediumThatBecomesTenTimesSlowerAndReturnsIsFollowed)
{
    ThinMedium medium;
    medium.BitsPerSecond = 1e6;
    medium.QueueBytes = 64 * 1024;
    Feed(medium, 30s);
    medium.BitsPerSecond = 1e5;
    Feed(medium, 5s);
    medium.LongestWait = 0s;
    Feed(medium, 5s);
    EXPECT_LT(medium.LongestWait, 300ms) << "five seconds after the fall";
    Feed(medium, 50s);
    medium.BitsPerSecond = 1e6;
    Feed(medium, 15s);
    medium.BytesCarried = 0;
    Feed(medium, 10s);
    EXPECT_GE(static_cast<double>(medium.BytesCarried) * 8, 0.8 * 1e6 * 10);
}

TEST(ThinMedium, ACommandWaitsForNoPictureOnAnotherLink)
{
    ThinMedium medium;
    medium.BitsPerSecond = 250e3;
    for (int i = 0; i < 300; ++i)
    {
        while (medium.A.Enqueue("beta", "pictures", 200000))
        {
        }
        medium.A.Enqueue("beta", "commands", 32);
        medium.Live(100ms);
    }
    EXPECT_LE(medium.B.Percentile("commands", 0.99), 250ms);
}

// Returns the bytes that a node sends within nine seconds to a peer that is gone, with `perSecond` messages
// of `size` bytes a second.
std::size_t BytesInVain(std::size_t size, int perSecond)
{
    ThinMedium medium;
    medium.A.Enqueue("beta", "q", 32);
    medium.Live(1s);
    medium.Cut = true;
    const std::size_t before = medium.BytesSent;
    for (int i = 0; i < 9 * perSecond; ++i)
    {
        medium.A.Enqueue("beta", "q", size);
        medium.Live(LinkTime(1s) / perSecond);
    }
    return medium.BytesSent - before;
}

// Other nodes need the channel.
constexpr std::size_t Datagram = 1312 + ThinMedium::Overhead;
constexpr std::size_t MostInVain = 9 * 2 * Datagram;

// Four datagrams are under way before an answer is missed. A medium that has become slow looks like one
// that carries nothing.
TEST(ThinMedium, ALargeMessageToWhoIsGoneTakesTwoDatagramsInVainAndSmallQuestions)
{
    EXPECT_LE(BytesInVain(100'000, 1), 12 * Datagram);
}

TEST(ThinMedium, ManyCommandsToWhoIsGoneTakeAtMostTwoDatagramsASecond)
{
    EXPECT_LE(BytesInVain(32, 100), MostInVain);
}

TEST(ThinMedium, NothingThatExpiredInAnOutageIsSentAfterIt)
{
    ThinMedium medium;
    medium.BitsPerSecond = 250e3;
    LinkOptions options;
    options.Expire = 2s;
    medium.A.Node->Configure("beta", "q", options, medium.Now);
    medium.A.Enqueue("beta", "q", 500);
    medium.Live(1s);
    medium.Cut = true;
    for (int i = 0; i < 200; ++i)
    {
        medium.A.Enqueue("beta", "q", 5000);
        medium.Live(300ms);
    }
    medium.Cut = false;
    const std::size_t before = medium.BytesSent;
    medium.Live(10s);
    const auto delivered = medium.A.Outcomes[static_cast<std::size_t>(LinkOutcome::Delivered)];
    EXPECT_LE(delivered, 8U) << "what was less than two seconds old when the path came back, and the first";
    EXPECT_LE(medium.BytesSent - before, 60000U);
    EXPECT_LE(medium.B.Percentile("q", 1), 2s);
}

// Instead of Run: one datagram at a time, as a scheduler requests them.
TEST(ThinMedium, StreamsGiveOneDatagramAtATimeAndAcknowledgementsFirst)
{
    ThinMedium medium;
    medium.A.Enqueue("beta", "q", 32);
    medium.Live(1s);
    medium.A.Enqueue("beta", "q", 3000);
    medium.A.Enqueue("beta", "other", 32);
    const auto ready = [&medium]
    {
        medium.A.Node->Advance(medium.Now);
        std::vector<std::string> queues;
        medium.A.Node->VisitStreams(1500, medium.Now,
                                    [&queues](const LinkStream &stream)
                                    {
                                        queues.emplace_back(stream.Queue);
                                        EXPECT_GT(stream.Bytes, 0U);
                                        EXPECT_LE(stream.Bytes, 1500U);
                                    });
        return queues;
    };
    EXPECT_EQ(ready(), (std::vector<std::string>{"other", "q"}));
    const std::size_t before = medium.Datagrams;
    EXPECT_TRUE(medium.A.Node->SendOne("beta", "q", 600, medium.Now));
    EXPECT_EQ(medium.Datagrams, before + 1);
    EXPECT_TRUE(medium.A.Node->SendOne("beta", "other", 1500, medium.Now));
    EXPECT_EQ(ready(), (std::vector<std::string>{"q"}));
    EXPECT_FALSE(medium.A.Node->SendOne("beta", "other", 1500, medium.Now));
    EXPECT_FALSE(medium.A.Node->SendOne("beta", "", 1500, medium.Now)) << "nothing to acknowledge";
    EXPECT_FALSE(medium.A.Node->SendOne("nobody", "q", 1500, medium.Now));
}

// Returns the size that a known or a new link states for its next datagram, and the bytes sent, for
// `messages` messages.
std::pair<std::size_t, std::size_t> SaidAndSent(const char *knownLink, int messages)
{
    ThinMedium medium;
    medium.A.Enqueue("beta", knownLink, 32);
    medium.Live(1s);
    for (int i = 0; i < messages; ++i)
    {
        medium.A.Enqueue("beta", "q", 60);
    }
    medium.A.Node->Advance(medium.Now);
    std::size_t said = 0;
    medium.A.Node->VisitStreams(1500, medium.Now, [&said](const LinkStream &stream) { said = stream.Bytes; });
    const std::size_t before = medium.BytesSent;
    EXPECT_TRUE(medium.A.Node->SendOne("beta", "q", 1500, medium.Now));
    return {said, medium.BytesSent - before};
}

// A schedule keeps the stated size free in a budget.
TEST(ThinMedium, AStreamSaysHowLargeItsNextDatagramIsWithAllThatGoesIntoIt)
{
    for (const int messages : {1, 2, 3, 5, 8, 100})
    {
        const auto [said, sent] = SaidAndSent("q", messages);
        EXPECT_GE(said, sent) << messages;
        EXPECT_LE(said, std::min<std::size_t>(sent + 150, 1500)) << messages;
        const auto [saidOfNew, sentOfNew] = SaidAndSent("other", messages);
        EXPECT_GE(saidOfNew, sentOfNew) << messages << ", with names";
    }
}

// The schedule now allows only smaller datagrams than when the part was cut.
TEST(ThinMedium, AStreamSaysThatALargePartGoesAgainAsItWasCut)
{
    ThinMedium medium;
    medium.A.Enqueue("beta", "q", 32);
    medium.Live(1s);
    medium.Cut = true;
    medium.A.Enqueue("beta", "q", 500);
    medium.Live(5ms);
    std::size_t said = 0;
    std::size_t sent = 0;
    for (int i = 0; i < 100 && sent == 0; ++i)
    {
        medium.Now += 10ms;
        medium.A.Node->Advance(medium.Now);
        said = 0;
        medium.A.Node->VisitStreams(400, medium.Now,
                                    [&said](const LinkStream &stream) { said = stream.Bytes; });
        const std::size_t before = medium.BytesSent;
        medium.A.Node->SendOne("beta", "q", 400, medium.Now);
        sent = medium.BytesSent - before;
    }
    EXPECT_GT(sent, 500U);
    EXPECT_GE(said, sent);
}

}  // namespace
}  // namespace Rabit::Test
