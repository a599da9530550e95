// A writer with one forged number, a little ahead of the true ones.
#include <gtest/gtest.h>

#include "guard/Gate.h"

namespace
{

using namespace RtpsBytes;

constexpr std::uint8_t HasData = 5;
constexpr EntityId Publications = 0x000003c2;

class SilencedWriterTest : public testing::Test
{
protected:
    SilencedWriterTest() { EXPECT_TRUE(Guard.Passes(ParticipantMessage())); }

    void Announce(std::uint32_t reliability)
    {
        const Bytes writer = List({Parameter(0x005a, Guid(Sender, UserWriter)),
                                   Parameter(0x0005, Text("Pose")), Parameter(0x0007, Text("Uav::Pose")),
                                   Parameter(0x001a, Join({U32(reliability), U32(0), U32(0)}))});
        EXPECT_TRUE(Guard.Passes(Message(Data, DataBody(1, writer, Publications), HasData)));
    }
    static Bytes Sample(std::int64_t number, std::uint32_t second)
    {
        return Join({Header(), Submessage(InfoTimestamp, Join({U32(1'700'000'000 + second), U32(0)})),
                     Submessage(Data, DataBody(number), HasData)});
    }
    // True if the third honest sample after a forged one is delivered as `expected`.
    bool GivesTheThird(const Bytes &expected)
    {
        EXPECT_TRUE(Guard.Passes(Sample(10, 10)));
        EXPECT_TRUE(Guard.Passes(Sample(26, 10)));
        EXPECT_TRUE(Guard.Passes(Sample(11, 11)));
        EXPECT_TRUE(Guard.Passes(Sample(12, 12)));
        EXPECT_TRUE(Guard.Admit(Sample(13, 13)));
        return Guard.Handed == std::vector<Bytes>{expected};
    }

    Gate Guard;
};

TEST_F(SilencedWriterTest, OfBestEffortIsHeardAgain)
{
    Announce(1);
    EXPECT_TRUE(GivesTheThird(Sample(27, 13)));
}

// A reader requests missing samples by the writer's numbers.
TEST_F(SilencedWriterTest, OfReliableKeepsItsNumbers)
{
    Announce(2);
    EXPECT_TRUE(GivesTheThird(Sample(13, 13)));
}

TEST_F(SilencedWriterTest, ATimeThatIsTakenBackIsOfNoSample)
{
    Announce(1);
    EXPECT_TRUE(Guard.Passes(Sample(26, 10)));
    for (std::int64_t number = 11; number < 20; ++number)
    {
        const Bytes sample =
            Join({Header(), Submessage(InfoTimestamp, Join({U32(1'800'000'000), U32(0)})),
                  Submessage(InfoTimestamp, {}, 3), Submessage(Data, DataBody(number), HasData)});
        EXPECT_TRUE(Guard.Passes(sample));
    }
}

// Forged numbers do not raise a writer's rate: the next number may be as far ahead of the true ones, and no
// farther.
TEST_F(SilencedWriterTest, IsHeldToItsOwnNumbersAgain)
{
    Announce(1);
    EXPECT_TRUE(GivesTheThird(Sample(27, 13)));
    EXPECT_TRUE(Guard.Stops(Sample(13 + 1'000'001, 13)));
}

}  // namespace
