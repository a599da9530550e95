// The texts by which nodes recognize each other in DDS discovery.
#include <gtest/gtest.h>
#include <rabit/gateway/QosProfileWords.h>

#include <span>
#include <string>

#include "common/ParticipantIdentity.h"
#include "names/RosNames.h"
#include "wire/GatewayTopics.h"

namespace Rabit::Test
{
namespace
{

std::span<const std::uint8_t> BytesIn(const std::string &text)
{
    return {reinterpret_cast<const std::uint8_t *>(text.data()), text.size()};
}

TEST(DiscoveryNames, ParticipantsHaveTheRecordedUserData)
{
    EXPECT_EQ(MakeUserData(7640891576956012808, true), "rabit=1;incarnation=7640891576956012808;card=2;");
    EXPECT_EQ(MakeUserData(1, false), "rabit=1;incarnation=1;");
}

TEST(DiscoveryNames, EndpointsHaveTheRecordedUserData)
{
    EXPECT_EQ(EndpointUserData, "rabit=1;");
    EXPECT_EQ(MakeEndpointUserData(""), "rabit=1;");
    EXPECT_EQ(MakeEndpointUserData("RIHS01_12"), "rabit=1;typehash=RIHS01_12;");
    EXPECT_EQ(ParseUserData(BytesIn(std::string(EndpointUserData))), std::nullopt)
        << "it is no participant's";
}

TEST(DiscoveryNames, TheRecordedUserDataIsThatOfANode)
{
    const std::string withCard = "rabit=1;incarnation=7640891576956012808;card=2;";
    EXPECT_EQ(ParseUserData(BytesIn(withCard)), 7640891576956012808U);
    EXPECT_TRUE(HasCard(BytesIn(withCard)));
    const std::string without = "rabit=1;incarnation=1;";
    EXPECT_EQ(ParseUserData(BytesIn(without)), 1U);
    EXPECT_FALSE(HasCard(BytesIn(without)));
}

TEST(DiscoveryNames, TopicsHaveTheRecordedNames)
{
    EXPECT_STREQ(GatewayTopics::Beat, "rabit/Beat");
    EXPECT_STREQ(GatewayTopics::Link, "rabit/Link");
    EXPECT_EQ(WordOf(QosProfile::State), "state");
    EXPECT_EQ(WordOf(QosProfile::Telemetry), "telemetry");
    EXPECT_EQ(RosTopicName("/chatter"), "rt/chatter");
    EXPECT_EQ(RosTypeName("std_msgs::msg::String"), "std_msgs::msg::dds_::String_");
}

}  // namespace
}  // namespace Rabit::Test
