// Forged discovery data in another participant's name, from another address, before the owner sends its
// own.
#include <gtest/gtest.h>

#include <algorithm>

#include "guard/Gate.h"

namespace
{

using namespace RtpsBytes;

constexpr Rabit::Rtps::HostAddress Elsewhere = {10, 0, 0, 66};
constexpr EntityId Publications = 0x000003c2;

class ElsewhereTest : public testing::Test
{
protected:
    ElsewhereTest() { EXPECT_TRUE(Guard.Passes(ParticipantMessage())); }

    static Bytes Forged()
    {
        Bytes forged = WriterMessage();
        const Bytes name = {'P', 'o', 's', 'e'};
        std::search(forged.begin(), forged.end(), name.begin(), name.end())[3] = 'f';
        return forged;
    }
    // Expects that the datagram is stopped from elsewhere at first and accepted when it is repeated (there
    // are such hosts). From home, `firstFromHome` passes at once.
    void ExpectItsOwnAlone(const Bytes &datagram, const Bytes &firstFromHome)
    {
        Guard.From = Elsewhere;
        EXPECT_TRUE(Guard.Stops(datagram));
        EXPECT_TRUE(Guard.Stops(datagram));
        Guard.From = SenderHost;
        EXPECT_TRUE(Guard.Passes(firstFromHome));
        Guard.From = Elsewhere;
        EXPECT_TRUE(Guard.Admit(datagram));
        EXPECT_EQ(Guard.Handed.size(), 1u);
    }

    Gate Guard;
};

TEST_F(ElsewhereTest, AnEndpointIsBelievedOfItsOwnerNotOfWhoIsQuicker)
{
    Guard.From = Elsewhere;
    EXPECT_TRUE(Guard.Stops(Forged()));
    Guard.From = SenderHost;
    EXPECT_TRUE(Guard.Passes(WriterMessage()));
}

TEST_F(ElsewhereTest, AnEndpointIsBelievedWhenItIsRepeated)
{
    ExpectItsOwnAlone(WriterMessage(UserWriter, 2), WriterMessage());
}

// A known announcement under the number of the next one, which would then be ignored as a repeat.
TEST_F(ElsewhereTest, ANumberIsNotTakenByWhatIsKnown)
{
    EXPECT_TRUE(Guard.Passes(WriterMessage()));
    Guard.From = Elsewhere;
    EXPECT_TRUE(Guard.Stops(WriterMessage(UserWriter, 2)));
}

TEST_F(ElsewhereTest, AGapOfDiscoveryIsBelievedWhenItIsRepeated)
{
    ExpectItsOwnAlone(Message(Gap, GapBody(2, 4, 0, Publications)), WriterMessage());
}

TEST_F(ElsewhereTest, AHeartbeatOfDiscoveryIsBelievedWhenItIsRepeated)
{
    ExpectItsOwnAlone(Message(Heartbeat, HeartbeatBody(3, 4, 1, Publications)), WriterMessage());
}

TEST_F(ElsewhereTest, AGoodbyeIsNotBelievedAtOnce)
{
    const Bytes goodbye = Message(Data,
                                  DataBody(2,
                                           Join({Parameter(0x0070, Guid(Sender, 0x000001c1)),
                                                 Parameter(0x0071, {0, 0, 0, 3}),
                                                 {1, 0, 0, 0}}),
                                           0x000100c2),
                                  3);
    Guard.From = Elsewhere;
    EXPECT_TRUE(Guard.Stops(goodbye));
    Guard.From = SenderHost;
    EXPECT_TRUE(Guard.Admit(goodbye));
    EXPECT_EQ(Guard.Handed.size(), 1u);
}

TEST_F(ElsewhereTest, AnAcknowledgementOfDiscoveryIsNotBelievedAtOnce)
{
    Bytes acknowledgement = Message(AckNack, AckNackBody(5, 0, 1));
    const Bytes ids = Ids(0x000003c7, Publications);
    const Bytes before = Ids(UserReader, UserWriter);
    const auto at =
        std::search(acknowledgement.begin(), acknowledgement.end(), before.begin() + 4, before.end());
    ASSERT_NE(at, acknowledgement.end());
    std::copy(ids.begin(), ids.end(), at - 4);
    Guard.From = Elsewhere;
    EXPECT_TRUE(Guard.Stops(acknowledgement));
    Guard.From = SenderHost;
    EXPECT_TRUE(Guard.Passes(acknowledgement));
}

TEST_F(ElsewhereTest, SamplesAreHeardFromAnywhere)
{
    EXPECT_TRUE(Guard.Passes(WriterMessage()));
    Guard.From = Elsewhere;
    EXPECT_TRUE(Guard.Passes(Message(Data, DataBody(1), 5)));
}

}  // namespace
