#include "recording/BlackBox.h"

#include <gmock/gmock.h>

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr std::uint64_t Second = 1000000000;

class BlackBoxTest : public testing::Test
{
protected:
    // Passes one item a second, up to `second`. Returns the items that were given out for writing.
    std::vector<std::uint64_t> PassUntil(std::uint64_t second)
    {
        std::vector<std::uint64_t> written;
        for (; _now < second; ++_now)
        {
            RecordingInbox::Batch batch;
            batch.Items.push_back({0, 0, _now * Second, 0, Mcap::Bytes(100)});
            batch.Events.swap(_events);
            _box.Take(batch, _now * Second);
            for (const RecordingItem &item : batch.Items)
            {
                written.push_back(item.LogTime / Second);
            }
            for (const RecordingItem &item : _box.LetGo())
            {
                _letGo.push_back(item.LogTime / Second);
            }
        }
        return written;
    }
    void Happens() { _events.push_back(_now * Second); }

    BlackBox _box{3s, 2s, 10 * (RecordingInbox::ItemSize + 100)};
    std::uint64_t _now = 0;
    std::vector<std::uint64_t> _events;
    std::vector<std::uint64_t> _letGo;
};

TEST_F(BlackBoxTest, GivesOutNothingWhileNothingHappens)
{
    EXPECT_THAT(PassUntil(100), IsEmpty());
    EXPECT_EQ(_letGo.size(), 96U);
    EXPECT_FALSE(_box.IsOpen());
}

TEST_F(BlackBoxTest, GivesOutWhatCameBeforeAndAfterWhatHappens)
{
    PassUntil(20);
    Happens();
    EXPECT_THAT(PassUntil(30), ElementsAre(17, 18, 19, 20, 21, 22));
    EXPECT_FALSE(_box.IsOpen());
}

TEST_F(BlackBoxTest, IsProlongedByWhatHappensMeanwhile)
{
    PassUntil(20);
    Happens();
    EXPECT_THAT(PassUntil(22), ElementsAre(17, 18, 19, 20, 21));
    EXPECT_TRUE(_box.IsOpen());
    Happens();
    EXPECT_THAT(PassUntil(40), ElementsAre(22, 23, 24));
}

TEST_F(BlackBoxTest, GivesOutNothingTwice)
{
    PassUntil(20);
    Happens();
    PassUntil(24);
    Happens();
    EXPECT_THAT(PassUntil(40), ElementsAre(23, 24, 25, 26));
}

TEST_F(BlackBoxTest, ClosesWhenNothingComesAnyMore)
{
    PassUntil(20);
    Happens();
    PassUntil(21);
    RecordingInbox::Batch batch;
    _box.Take(batch, 22 * Second);
    EXPECT_TRUE(_box.IsOpen());
    _box.Take(batch, 22 * Second + 1);
    EXPECT_FALSE(_box.IsOpen());
}

TEST(BlackBox, KeepsNoMoreThanItsMemoryHolds)
{
    BlackBox box(1h, 1s, 5 * (RecordingInbox::ItemSize + 100));
    RecordingInbox::Batch batch;
    for (std::uint64_t time = 1; time <= 8; ++time)
    {
        batch.Items.push_back({0, 0, time, 0, Mcap::Bytes(100)});
    }
    box.Take(batch, 8);
    EXPECT_EQ(box.LetGo().size(), 3U);
    batch.Events = {9};
    box.Take(batch, 9);
    ASSERT_EQ(batch.Items.size(), 5U);
    EXPECT_EQ(batch.Items[0].LogTime, 4U);
}

}  // namespace
}  // namespace Rabit
