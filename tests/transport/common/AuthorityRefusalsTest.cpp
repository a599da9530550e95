// Announcements that certificates do not allow are told as long as they stand.
#include "common/AuthorityRefusals.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>

namespace
{

using Rabit::Rtps::AuthorityRefusals;
using Rabit::Rtps::GuidPrefix;
using Rabit::Rtps::ParticipantEntity;

constexpr Rabit::Rtps::EntityId RefusedEndpoint = 0x00000103;
constexpr AuthorityRefusals::TimePoint FirstRefusal{std::chrono::hours(1)};
constexpr GuidPrefix RefusedPeer{1, 15};

class AuthorityRefusalsTest : public testing::Test
{
protected:
    void Refuse(Rabit::Rtps::EntityId subject, AuthorityRefusals::TimePoint now)
    {
        Refusals.Refused(RefusedPeer, subject, {.Node = "uav1", .Text = "text"}, now);
    }
    std::size_t At(AuthorityRefusals::TimePoint now) const { return Refusals.LastingRefusals(now).size(); }

    AuthorityRefusals Refusals;
};

TEST_F(AuthorityRefusalsTest, AnEndpointIsToldOnceItsRefusalLasts)
{
    Refuse(RefusedEndpoint, FirstRefusal);
    EXPECT_EQ(At(FirstRefusal + AuthorityRefusals::Lasting - std::chrono::milliseconds(1)), 0u);
    EXPECT_EQ(At(FirstRefusal + AuthorityRefusals::Lasting), 1u);
    EXPECT_EQ(At(FirstRefusal + std::chrono::hours(5)), 1u);
}

TEST_F(AuthorityRefusalsTest, ARepetitionDoesNotBeginAnew)
{
    Refuse(RefusedEndpoint, FirstRefusal);
    Refuse(RefusedEndpoint, FirstRefusal + std::chrono::seconds(9));
    EXPECT_EQ(At(FirstRefusal + AuthorityRefusals::Lasting), 1u);
}

TEST_F(AuthorityRefusalsTest, AnEndpointThatIsGoneIsNotTold)
{
    Refuse(RefusedEndpoint, FirstRefusal);
    Refusals.Gone(RefusedPeer, RefusedEndpoint);
    EXPECT_EQ(At(FirstRefusal + AuthorityRefusals::Lasting), 0u);
}

TEST_F(AuthorityRefusalsTest, AParticipantThatIsNotHeardAgainIsNotTold)
{
    Refuse(ParticipantEntity, FirstRefusal);
    EXPECT_EQ(At(FirstRefusal + AuthorityRefusals::Repeated), 1u);
    EXPECT_EQ(At(FirstRefusal + AuthorityRefusals::Repeated + std::chrono::milliseconds(1)), 0u);
}

TEST_F(AuthorityRefusalsTest, OfTooManyTheOldestIsForgotten)
{
    for (std::uint32_t i = 0; i <= AuthorityRefusals::Most; ++i)
    {
        Refusals.Refused(RefusedPeer, RefusedEndpoint + (i << 8), {.Node = "uav1", .Text = std::to_string(i)},
                         FirstRefusal + std::chrono::milliseconds(i));
    }
    const auto rows = Refusals.LastingRefusals(FirstRefusal + std::chrono::minutes(1));
    ASSERT_EQ(rows.size(), AuthorityRefusals::Most);
    EXPECT_EQ(rows.front().Text, "1");
}

}  // namespace
