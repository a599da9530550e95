// Announcements that the certificate of their sender does not allow reach no vendor.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "guard/RtpsBytes.h"
#include "guard/RtpsGuard.h"

namespace
{

using namespace RtpsBytes;
using Rabit::Rtps::Ledger;
using Rabit::Rtps::RtpsGuard;

constexpr EntityId SecondWriter = 0x00000203;

Bytes EndpointData(EntityId endpoint, const Bytes &topics)
{
    return List({Parameter(0x005a, Guid(Sender, endpoint)), topics, Parameter(0x0007, Text("Uav::Pose"))});
}

Bytes TopicParameter(const char *name)
{
    return Parameter(0x0005, Text(name));
}

Bytes Announces(EntityId builtinWriter, std::int64_t number, EntityId endpoint, const Bytes &topics)
{
    return Message(Data, DataBody(number, EndpointData(endpoint, topics), builtinWriter), 0x05);
}

// The participant `Sender` has the certificate of uav1, which allows it to write Pose and to read Mission.
class AuthorityTest : public testing::Test
{
protected:
    AuthorityTest()
    {
        Guard.SetAuthority(
            {.May = [](const GuidPrefix &peer, bool write, std::string_view topic)
             { return peer == Sender && topic == (write ? "Pose" : "Mission"); },
             .NameOf = [this](const GuidPrefix &peer) { return peer == Sender ? Name : std::nullopt; }});
    }

    // Returns false if the guard counts something. `Handed` has what it delivers.
    bool Admit(Bytes datagram, RtpsGuard::Origin origin = RtpsGuard::Origin::Network)
    {
        Handed.clear();
        return Guard.Admit(
            datagram, SenderHost, Now,
            [this](std::span<std::uint8_t> admitted)
            { Handed.emplace_back(admitted.begin(), admitted.end()); },
            origin);
    }
    bool Passes(const Bytes &datagram, RtpsGuard::Origin origin = RtpsGuard::Origin::Network)
    {
        return Admit(datagram, origin) && Handed == std::vector<Bytes>{datagram};
    }
    bool PassesAsWriter(const char *topic, std::int64_t number = 1, EntityId writer = UserWriter)
    {
        return Passes(Announces(Rabit::Rtps::PublicationsWriter, number, writer, TopicParameter(topic)));
    }
    bool PassesAsReader(const char *topic)
    {
        return Passes(Announces(Rabit::Rtps::SubscriptionsWriter, 1, UserReader, TopicParameter(topic)));
    }
    std::size_t Problems() { return Accounts->OfAuthority().LastingRefusals(Now).size(); }

    std::optional<std::string> Name = "uav1";
    std::vector<Bytes> Handed;
    RtpsGuard::TimePoint Now{std::chrono::hours(1)};
    const std::shared_ptr<Ledger> Accounts = std::make_shared<Ledger>();
    RtpsGuard Guard{RtpsGuard::Mode::Full, std::chrono::seconds(10), RtpsGuard::Vendor::FastDds,
                    std::make_shared<Rabit::Rtps::RecentGoodbyes>(), Accounts};
};

TEST_F(AuthorityTest, AParticipantWithTheNameInItsCertificateIsHandedOn)
{
    EXPECT_TRUE(Admit(ParticipantMessage()));
    EXPECT_EQ(Handed.size(), 1u);
}

// It gets samples and repairs, also if it only reads.
TEST_F(AuthorityTest, AParticipantWithTheNameInItsCertificateIsNoStranger)
{
    EXPECT_TRUE(Admit(ParticipantMessage()));
    EXPECT_FALSE(Accounts->IsStranger(Sender));
    EXPECT_TRUE(Admit(ParticipantMessage(Other)));
    EXPECT_TRUE(Accounts->IsStranger(Other));
}

TEST_F(AuthorityTest, AParticipantWithTheNameInItsCertificateIsNoStrangerByItsCard)
{
    EXPECT_TRUE(Admit(ParticipantMessage(), RtpsGuard::Origin::Card));
    EXPECT_FALSE(Accounts->IsStranger(Sender));
}

TEST_F(AuthorityTest, AParticipantWithAnotherNameIsRefused)
{
    Name = "ground";
    EXPECT_FALSE(Admit(ParticipantMessage()));
    EXPECT_TRUE(Handed.empty());
}

TEST_F(AuthorityTest, AParticipantWithAnotherNameIsRefusedInACard)
{
    Name = "ground";
    EXPECT_FALSE(Admit(ParticipantMessage(), RtpsGuard::Origin::Card));
    EXPECT_TRUE(Handed.empty());
}

TEST_F(AuthorityTest, AParticipantWithoutAKnownCertificateIsIgnoredUntilItIsKnown)
{
    Name = std::nullopt;
    EXPECT_TRUE(Admit(ParticipantMessage()));
    EXPECT_TRUE(Handed.empty());
    Name = "uav1";
    EXPECT_TRUE(Admit(ParticipantMessage()));
    EXPECT_EQ(Handed.size(), 1u);
}

// A card is delivered in the name of the participant whose card it is.
TEST_F(AuthorityTest, ACardOfAParticipantWithoutAKnownCertificateIsIgnored)
{
    EXPECT_TRUE(Admit(ParticipantMessage(Other), RtpsGuard::Origin::Card));
    EXPECT_TRUE(Handed.empty());
}

TEST_F(AuthorityTest, AnAllowedWriterIsHandedOn)
{
    ASSERT_TRUE(Admit(ParticipantMessage()));
    EXPECT_TRUE(PassesAsWriter("Pose"));
}

TEST_F(AuthorityTest, AnAllowedReaderIsHandedOn)
{
    ASSERT_TRUE(Admit(ParticipantMessage()));
    EXPECT_TRUE(PassesAsReader("Mission"));
}

TEST_F(AuthorityTest, PermissionToReadIsNoneToWrite)
{
    ASSERT_TRUE(Admit(ParticipantMessage()));
    EXPECT_FALSE(PassesAsWriter("Mission"));
    EXPECT_FALSE(PassesAsReader("Pose"));
}

TEST_F(AuthorityTest, AForbiddenWriterBecomesAGapOfItsNumber)
{
    ASSERT_TRUE(Admit(ParticipantMessage()));
    const Bytes announcement =
        Announces(Rabit::Rtps::PublicationsWriter, 1, UserWriter, TopicParameter("Secret"));
    EXPECT_FALSE(Admit(announcement));
    ASSERT_EQ(Handed.size(), 1u);
    // It names the reader: Cyclone DDS passes over others, and waits for the number for ever.
    constexpr EntityId publicationsReader = 0x000003c7;
    const Bytes expected =
        Join({Header(), Submessage(Gap, Join({Ids(publicationsReader, Rabit::Rtps::PublicationsWriter),
                                              Sequence(1), Sequence(2), Bits(0)}))});
    ASSERT_EQ(Handed[0].size(), announcement.size());
    const std::size_t at = expected.size();
    EXPECT_TRUE(std::equal(expected.begin(), expected.end(), Handed[0].begin()));
    EXPECT_EQ(Handed[0][at], 0x01) << "padding";
    EXPECT_EQ(Handed[0][at + 2] + 256 * Handed[0][at + 3], static_cast<int>(announcement.size() - at - 4));
}

TEST_F(AuthorityTest, AForbiddenWriterBecomesAGapInACard)
{
    ASSERT_TRUE(Admit(ParticipantMessage(), RtpsGuard::Origin::Card));
    EXPECT_FALSE(Admit(Announces(Rabit::Rtps::PublicationsWriter, 1, UserWriter, TopicParameter("Secret")),
                       RtpsGuard::Origin::Card));
    ASSERT_EQ(Handed.size(), 1u);
    EXPECT_EQ(Handed[0][Rabit::Rtps::RtpsHeaderSize], Gap);
}

TEST_F(AuthorityTest, TheNextWriterIsHandedOnAfterAForbiddenOne)
{
    ASSERT_TRUE(Admit(ParticipantMessage()));
    EXPECT_FALSE(PassesAsWriter("Secret", 1));
    EXPECT_TRUE(PassesAsWriter("Pose", 2, SecondWriter));
}

TEST_F(AuthorityTest, SamplesOfAForbiddenWriterAreNotHandedOn)
{
    ASSERT_TRUE(Admit(ParticipantMessage()));
    EXPECT_FALSE(PassesAsWriter("Secret"));
    Admit(Message(Data, DataBody(1), 0x05));
    EXPECT_TRUE(Handed.empty());
}

// Two vendors may take one topic each.
TEST_F(AuthorityTest, AnAnnouncementWithTwoTopicsIsForbidden)
{
    ASSERT_TRUE(Admit(ParticipantMessage()));
    EXPECT_FALSE(Passes(Announces(Rabit::Rtps::PublicationsWriter, 1, UserWriter,
                                  Join({TopicParameter("Pose"), TopicParameter("Pose")}))));
}

// A vendor may take the name in front of the zero byte.
TEST_F(AuthorityTest, ATopicWithAZeroByteInItIsForbidden)
{
    ASSERT_TRUE(Admit(ParticipantMessage()));
    const Bytes topic = Parameter(0x0005, Join({U32(7), {'P', 'o', 's', 'e', 0, 'x', 0, 0}}));
    EXPECT_FALSE(Passes(Announces(Rabit::Rtps::PublicationsWriter, 1, UserWriter, topic)));
}

TEST_F(AuthorityTest, AForbiddenWriterIsAProblemOnceItLasts)
{
    ASSERT_TRUE(Admit(ParticipantMessage()));
    EXPECT_FALSE(PassesAsWriter("Secret"));
    EXPECT_EQ(Problems(), 0u);
    Now += std::chrono::seconds(10);
    ASSERT_EQ(Problems(), 1u);
    const auto row = Accounts->OfAuthority().LastingRefusals(Now)[0];
    EXPECT_EQ(row.Node, "uav1");
    EXPECT_NE(row.Text.find("Secret"), std::string::npos) << row.Text;
}

TEST_F(AuthorityTest, AForbiddenWriterIsNoProblemOnceItsParticipantHasLeft)
{
    ASSERT_TRUE(Admit(ParticipantMessage()));
    EXPECT_FALSE(PassesAsWriter("Secret"));
    Now += std::chrono::seconds(10);
    Accounts->Left(Sender);
    EXPECT_EQ(Problems(), 0u);
}

TEST_F(AuthorityTest, AForbiddenReaderBecomesAGap)
{
    ASSERT_TRUE(Admit(ParticipantMessage()));
    EXPECT_FALSE(PassesAsReader("Secret"));
    ASSERT_EQ(Handed.size(), 1u);
    EXPECT_EQ(Handed[0][Rabit::Rtps::RtpsHeaderSize], Gap);
}

}  // namespace
