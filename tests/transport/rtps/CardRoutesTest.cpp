// Where cards, and requests for them, go.
#include "rtps/CardRoutes.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <optional>
#include <vector>

#include "rtps/Meeting.h"

namespace
{

using namespace std::chrono_literals;
using Rabit::Rtps::GuidPrefix;
using Rabit::Rtps::Meeting;
using Rabit::Rtps::Place;
using Routes = Rabit::Rtps::CardRoutes<int>;

constexpr Routes::TimePoint RoutesStart{1h};
constexpr Place HeardPlace{.Host = {10, 0, 0, 2}, .Port = 7410};

GuidPrefix ParticipantNumber(int number)
{
    return {1, 15, static_cast<std::uint8_t>(number)};
}

TEST(RoutesOfCards, LeadToWhereAParticipantWasHeardUntilSomethingIsSentToIt)
{
    Routes routes(1s);
    routes.NoteHeard(ParticipantNumber(1), HeardPlace, RoutesStart);
    const std::vector<Place> heard{HeardPlace};
    EXPECT_EQ(routes.HeardAt(ParticipantNumber(1), RoutesStart), heard);
    EXPECT_EQ(routes.HeardAt(std::nullopt, RoutesStart), heard);
    EXPECT_TRUE(routes.HeardAt(ParticipantNumber(2), RoutesStart).empty());
    routes.Note(ParticipantNumber(1), 7);
    routes.NoteHeard(ParticipantNumber(1), HeardPlace, RoutesStart);
    EXPECT_TRUE(routes.HeardAt(ParticipantNumber(1), RoutesStart).empty());
    EXPECT_TRUE(routes.HeardAt(std::nullopt, RoutesStart).empty());
    EXPECT_EQ(routes.To(ParticipantNumber(1), RoutesStart), std::vector<int>{7});
}

TEST(RoutesOfCards, LeadNowhereOnceAParticipantIsSilent)
{
    Routes routes(1s);
    routes.NoteHeard(ParticipantNumber(1), HeardPlace, RoutesStart);
    EXPECT_FALSE(routes.HeardAt(std::nullopt, RoutesStart + 3s).empty());
    EXPECT_TRUE(routes.HeardAt(std::nullopt, RoutesStart + 3001ms).empty());
}

TEST(RoutesOfCards, ToParticipantsThatWereHeardAreFew)
{
    Routes routes(1s);
    for (int number = 0; number < 200; ++number)
    {
        routes.NoteHeard(ParticipantNumber(number), HeardPlace, RoutesStart);
    }
    EXPECT_EQ(routes.HeardAt(std::nullopt, RoutesStart).size(), Routes::MostHeard);
    routes.NoteHeard(ParticipantNumber(201), HeardPlace, RoutesStart + 4s);
    EXPECT_EQ(routes.HeardAt(std::nullopt, RoutesStart + 4s).size(), 1u);
}

// Without multicast and peers its implementation sends nothing before it knows another participant.
TEST(RoutesOfCards, AreAskedForByANodeThatHasSentNothing)
{
    Meeting meeting(Meeting::Settings{.Period = 1s, .Memory = 4h, .IsMulticast = false});
    meeting.SetSelf(ParticipantNumber(1));
    meeting.Announced(ParticipantNumber(2), true, RoutesStart);
    const auto asked = meeting.TakeForNetwork(RoutesStart + 1s);
    ASSERT_TRUE(asked.has_value());
    EXPECT_EQ(asked->To, ParticipantNumber(2));
}

}  // namespace
