#include "presence/SentBeats.h"

#include <gtest/gtest.h>

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using Ns = std::chrono::nanoseconds;

TEST(SentBeats, KnowsNoneBeforeTheFirst)
{
    EXPECT_EQ(SentBeats().Find(0), std::nullopt);
}

TEST(SentBeats, TellsWhenABeatWasSentByTheLowerHalfOfItsSourceTime)
{
    SentBeats sent;
    sent.Add((std::int64_t{77} << 32) + 5, 3s);
    sent.Add((std::int64_t{77} << 32) + 9, 4s);
    EXPECT_EQ(sent.Find(5), Ns(3s));
    EXPECT_EQ(sent.Find(9), Ns(4s));
    EXPECT_EQ(sent.Find(6), std::nullopt);
}

TEST(SentBeats, RemembersTheNewestOnes)
{
    SentBeats sent;
    for (int i = 0; i < 1000; ++i)
    {
        sent.Add(i, i * 1s);
    }
    EXPECT_EQ(sent.Find(999), Ns(999s));
    EXPECT_EQ(sent.Find(1000 - 256), Ns(744s));
    EXPECT_EQ(sent.Find(1000 - 257), std::nullopt);
}

}  // namespace
}  // namespace Rabit
