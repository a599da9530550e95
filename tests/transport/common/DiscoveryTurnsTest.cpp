// Which exchange of a session gets the next turn.
#include <gtest/gtest.h>
#include <rabit/transport/DiscoveryTurns.h>

#include <chrono>
#include <cstddef>

namespace
{

using namespace std::chrono_literals;
using Rabit::DiscoveryTurns;

class Exchange final : public DiscoveryTurns::Exchange
{
public:
    explicit Exchange(int datagrams, std::chrono::nanoseconds late = 0ns) : Left(datagrams), Late(late) {}
    std::size_t NextBytes() override { return Left > 0 ? 100 : 0; }
    void SendNext() override { --Left; }
    std::chrono::nanoseconds QueueingDelay() const override { return Late; }

    int Left;
    std::chrono::nanoseconds Late;
};

class DiscoveryTurnsTest : public testing::Test
{
protected:
    DiscoveryTurnsTest()
    {
        Turns.SetExchange(Cards);
        Turns.SetExchange(Introduction, DiscoveryTurns::Kind::Introduction);
    }
    bool Serve()
    {
        const bool isDue = Turns.NextBytes() > 0;
        Turns.SendNext();
        return isDue;
    }

    Exchange Cards{2, 30ms};
    Exchange Introduction{1};
    DiscoveryTurns Turns;
};

TEST_F(DiscoveryTurnsTest, GoToTheIntroductionBeforeCards)
{
    EXPECT_TRUE(Serve());
    EXPECT_EQ(Introduction.Left, 0);
    EXPECT_EQ(Cards.Left, 2);
    EXPECT_TRUE(Serve());
    EXPECT_TRUE(Serve());
    EXPECT_EQ(Cards.Left, 0);
    EXPECT_FALSE(Serve());
    EXPECT_FALSE(Turns.IsDue());
}

TEST_F(DiscoveryTurnsTest, GoToEachExchangeHoweverMuchTheOtherOneHasDue)
{
    Introduction.Left = 100;
    for (int turn = 0; turn < 4; ++turn)
    {
        EXPECT_TRUE(Serve());
    }
    EXPECT_EQ(Introduction.Left, 98);
    EXPECT_EQ(Cards.Left, 0);
}

TEST_F(DiscoveryTurnsTest, GoToTheExchangeWhoseBytesWereSaid)
{
    Introduction.Left = 0;
    ASSERT_GT(Turns.NextBytes(), 0u);
    Introduction.Left = 1;
    Turns.SendNext();
    EXPECT_EQ(Cards.Left, 1);
}

TEST_F(DiscoveryTurnsTest, DoNotGoToARemovedExchange)
{
    ASSERT_GT(Turns.NextBytes(), 0u);
    Turns.RemoveExchange(Introduction);
    Turns.SendNext();
    EXPECT_EQ(Introduction.Left, 1);
    EXPECT_TRUE(Serve());
    EXPECT_EQ(Cards.Left, 1);
}

TEST_F(DiscoveryTurnsTest, GoToTheLastExchangeOfAKind)
{
    Exchange later{1};
    Turns.SetExchange(later, DiscoveryTurns::Kind::Introduction);
    Turns.RemoveExchange(Introduction);
    EXPECT_TRUE(Serve());
    EXPECT_EQ(later.Left, 0);
    Turns.RemoveExchange(later);
}

TEST_F(DiscoveryTurnsTest, TellTheLongestDelay)
{
    EXPECT_EQ(Turns.QueueingDelay(), 30ms);
}

}  // namespace
