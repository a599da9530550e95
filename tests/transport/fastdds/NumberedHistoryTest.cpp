// Samples that wait for earlier ones of their writer are found by number, whatever their timestamps are.
#include "NumberedHistory.h"

#include <gtest/gtest.h>

#include <deque>

namespace
{

namespace rtps = Rabit::FastDds::rtps;

class NumberedHistoryTest : public testing::Test, private Rabit::FastDds::NumberedHistory
{
protected:
    NumberedHistoryTest() : NumberedHistory(rtps::HistoryAttributes{}) { mp_mutex = &_mutex; }
    // The samples belong to this test, not to the vendor's pool.
    ~NumberedHistoryTest() override { m_changes.clear(); }

    void Receive(rtps::octet writer, std::uint32_t number, std::uint32_t timestamp)
    {
        rtps::CacheChange_t &change = _changes.emplace_back();
        change.writerGUID = From(writer);
        change.sequenceNumber = {0, number};
        change.sourceTimestamp = rtps::Time_t(0, timestamp);
        ASSERT_TRUE(received_change(&change, 0));
    }

    // Looks for the sample as the vendor does once all before it have come.
    bool IsFound(rtps::octet writer, std::uint32_t number)
    {
        rtps::CacheChange_t *found = nullptr;
        return get_change({0, number}, From(writer), &found) && found->sequenceNumber.low == number;
    }

private:
    static rtps::GUID_t From(rtps::octet writer)
    {
        rtps::GUID_t guid;
        guid.guidPrefix.value[11] = writer;
        return guid;
    }

    Rabit::FastDds::RecursiveTimedMutex _mutex;
    std::deque<rtps::CacheChange_t> _changes;
};

TEST_F(NumberedHistoryTest, FindsALateSampleOfTheSameTime)
{
    Receive(1, 3, 100);
    Receive(1, 1, 100);
    Receive(1, 2, 100);
    EXPECT_TRUE(IsFound(1, 1));
    EXPECT_TRUE(IsFound(1, 2));
    EXPECT_TRUE(IsFound(1, 3));
}

TEST_F(NumberedHistoryTest, FindsSamplesOfAClockThatWentBack)
{
    Receive(1, 3, 50);
    Receive(1, 1, 100);
    Receive(1, 2, 75);
    EXPECT_TRUE(IsFound(1, 1));
    EXPECT_TRUE(IsFound(1, 2));
    EXPECT_TRUE(IsFound(1, 3));
}

TEST_F(NumberedHistoryTest, FindsSamplesOfSeveralWriters)
{
    Receive(1, 8, 100);
    Receive(2, 1, 100);
    Receive(2, 9, 10);
    Receive(1, 2, 100);
    for (const std::uint32_t number : {2u, 8u})
    {
        EXPECT_TRUE(IsFound(1, number)) << number;
        EXPECT_FALSE(IsFound(2, number)) << number;
    }
    EXPECT_TRUE(IsFound(2, 1));
    EXPECT_TRUE(IsFound(2, 9));
}

}  // namespace
