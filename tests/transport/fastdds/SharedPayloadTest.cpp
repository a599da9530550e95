// Fast DDS 3 takes a payload a second time while it sends it, maybe until after the sample is gone.
#include <gtest/gtest.h>

#include <algorithm>

#include "PayloadPool.h"

namespace
{

using Rabit::FastDds::MaxSample;
using Rabit::FastDds::PayloadPool;

class SharedPayloadTest : public testing::Test
{
protected:
    void Release(PayloadPool::Payload &payload) { payload.payload_owner->release_payload(payload); }

    PayloadPool Pool{[] {}};
    PayloadPool::Payload Sample;
    PayloadPool::Payload Sent;
    PayloadPool::Payload SentToo;
};

TEST_F(SharedPayloadTest, IsTheSameMemory)
{
    ASSERT_TRUE(Pool.get_payload(100, Sample));
    ASSERT_TRUE(Pool.get_payload(Sample, Sent));
    EXPECT_EQ(Sent.data, Sample.data);
    EXPECT_EQ(Sent.length, Sample.length);
    Release(Sample);
    Release(Sent);
}

TEST_F(SharedPayloadTest, OutlivesTheSample)
{
    ASSERT_TRUE(Pool.get_payload(100'000, Sample));
    std::fill_n(Sample.data, Sample.max_size, std::uint8_t{7});
    ASSERT_TRUE(Pool.get_payload(Sample, Sent));
    ASSERT_TRUE(Pool.get_payload(Sample, SentToo));
    Release(Sample);
    Release(SentToo);
    PayloadPool::Payload other;
    ASSERT_TRUE(Pool.get_payload(100'000, other));
    EXPECT_NE(other.data, Sent.data);
    EXPECT_EQ(std::count(Sent.data, Sent.data + 100'000, 7), 100'000);
    Release(other);
    Release(Sent);
}

TEST_F(SharedPayloadTest, CountsOnceAgainstTheLimit)
{
    ASSERT_TRUE(Pool.get_payload(MaxSample, Sample));
    ASSERT_TRUE(Pool.get_payload(Sample, Sent));
    ASSERT_TRUE(Pool.get_payload(Sample, SentToo));
    PayloadPool::Payload other;
    EXPECT_TRUE(Pool.get_payload(MaxSample, other));
    Release(other);
    Release(Sent);
    Release(SentToo);
    Release(Sample);
    ASSERT_TRUE(Pool.get_payload(MaxSample, Sample));
    ASSERT_TRUE(Pool.get_payload(MaxSample, other));
    Release(other);
    Release(Sample);
}

}  // namespace
