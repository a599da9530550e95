// The USER_DATA in the announcements of writers and readers.
#include <gtest/gtest.h>

#include <string>

#include "EndpointSettings.h"
#include "common/ParticipantIdentity.h"

namespace
{

template <typename EndpointQos>
std::string UserDataOf(const EndpointQos &qos)
{
    const auto &data = qos.m_userData.data_vec();
    return {data.begin(), data.end()};
}

TEST(EndpointUserData, IsInTheAnnouncementOfEachWriterAndReader)
{
    EXPECT_EQ(UserDataOf(Rabit::FastDds::MakeWriterQos({}, {}, {})), Rabit::EndpointUserData);
    EXPECT_EQ(UserDataOf(Rabit::FastDds::MakeReaderQos({}, {}, {})), Rabit::EndpointUserData);
}

TEST(EndpointUserData, HasTheHashOfTheType)
{
    const Rabit::TopicDescription topic{
        .Name = "rt/words", .TypeName = "std_msgs::msg::dds_::String_", .KeyOf = {}, .TypeHash = "RIHS01_12"};
    EXPECT_EQ(UserDataOf(Rabit::FastDds::MakeWriterQos(topic, {}, {})), "rabit=1;typehash=RIHS01_12;");
    EXPECT_EQ(UserDataOf(Rabit::FastDds::MakeReaderQos(topic, {}, {})), "rabit=1;typehash=RIHS01_12;");
}

}  // namespace
