// Nodes with keys over Fast DDS.
#include <rabit/fastdds/FastDdsTransport.h>

#include <gmock/gmock.h>

#include <memory>
#include <string>

#include "../common/TestMembers.h"
#include "../conformance/ForbiddenTopic.h"
#include "../conformance/NetworkFixture.h"
#include "../conformance/ProcessHarness.h"
#include "../conformance/Recorder.h"

namespace Rabit::Conformance
{

namespace
{

std::unique_ptr<TransportHarness> MakePlainFastDds()
{
    return std::make_unique<ProcessHarness>(std::make_unique<FastDdsTransport>());
}

std::string ProfileOf(const std::string &transports, const std::string &participant)
{
    return R"(<?xml version="1.0" encoding="UTF-8"?>
<dds xmlns="http://www.eprosima.com/XMLSchemas/fastRTPS_Profiles">
  <profiles>)" +
           transports + R"(
    <participant profile_name="base" is_default_profile="true">
      <rtps>)" +
           participant + R"(</rtps>
    </participant>
  </profiles>
</dds>)";
}

// A session, and its endpoints of one topic.
struct Talking
{
    Talking(Transport &backend, const TransportSettings &settings)
        : Session(backend.Open(settings, Peers.Handler())),
          Writer(Session->CreateWriter(TextTopic(), State(), {})),
          Reader(Session->CreateReader(TextTopic(), State(), {}, Heard.Handler()))
    {
    }

    PeerRecorder Peers;
    SampleRecorder Heard;
    std::unique_ptr<TransportSession> Session;
    std::unique_ptr<TransportWriter> Writer;
    std::unique_ptr<TransportReader> Reader;
};

class FastDdsMembersTest : public testing::Test, protected NetworkFixture
{
protected:
    FastDdsMembersTest() : NetworkFixture(MakePlainFastDds()) {}

    TransportSettings SettingsOf(const std::string &node,
                                 const TestMembers::Rules &rules = TestMembers::Everything())
    {
        auto settings = Settings(node);
        settings.Member = Fleet.Member(node, rules);
        return settings;
    }
    // Waits until each of the two has a sample of the other one.
    bool Talk(Talking &one, Talking &other)
    {
        return Net().Until(
            [&]
            {
                WriteOnceTaken(*one.Writer, MakeSample(0, "one"), 1);
                WriteOnceTaken(*other.Writer, MakeSample(0, "other"), 1);
                return one.Heard.Count() > 0 && other.Heard.Count() > 0;
            });
    }

    TestMembers Fleet;
};

TEST_F(FastDdsMembersTest, MembersDeliverToEachOther)
{
    ExpectDelivery(SettingsOf("uav1"), SettingsOf("ground"));
}

TEST_F(FastDdsMembersTest, MembersDeliverToEachOtherInLargeDatagrams)
{
    auto uav = SettingsOf("uav1");
    uav.MaxDatagram = TransportSettings::LargestDatagram;
    ExpectDelivery(uav, SettingsOf("ground"));
}

TEST_F(FastDdsMembersTest, NodesWithoutKeysAndMembersDoNotHearEachOther)
{
    Talking uav(Backend(), SettingsOf("uav1"));
    Talking ground(Backend(), SettingsOf("ground"));
    Talking plain(Backend(), Settings("plain"));
    Talking other(Backend(), Settings("other"));
    ASSERT_TRUE(Talk(uav, ground));
    ASSERT_TRUE(Talk(plain, other));
    for (const Talking *each : {&uav, &ground, &plain, &other})
    {
        EXPECT_EQ(each->Reader->MatchedWriters(), 1);
        EXPECT_EQ(each->Peers.CountAll(), 1u);
    }
    EXPECT_THAT(uav.Heard.Texts(), testing::Each("other"));
    EXPECT_THAT(plain.Heard.Texts(), testing::Each("other"));
}

TEST_F(FastDdsMembersTest, MembersOfTwoFleetsDoNotHearEachOther)
{
    TestMembers another("another");
    auto theirs = Settings("stranger");
    theirs.Member = another.Member("stranger");
    auto alsoTheirs = Settings("other");
    alsoTheirs.Member = another.Member("other");
    Talking uav(Backend(), SettingsOf("uav1"));
    Talking ground(Backend(), SettingsOf("ground"));
    Talking stranger(Backend(), theirs);
    Talking other(Backend(), alsoTheirs);
    ASSERT_TRUE(Talk(uav, ground));
    ASSERT_TRUE(Talk(stranger, other));
    for (const Talking *each : {&uav, &ground, &stranger, &other})
    {
        EXPECT_EQ(each->Reader->MatchedWriters(), 1);
        EXPECT_EQ(each->Peers.CountAll(), 1u);
    }
}

// The forbidden writer is announced first, and keeps no other one from being heard.
TEST_F(FastDdsMembersTest, AMemberDeliversNothingOnATopicThatItsPermissionsLack)
{
    const auto uav =
        Backend().Open(SettingsOf("uav1", {{.Topic = "Pose", .MayWrite = true, .MayRead = true}}), {});
    const auto ground = Backend().Open(SettingsOf("ground"), {});
    const BesideForbidden told = TalkBesideForbidden(Net(), *uav, *ground);
    ASSERT_TRUE(told.IsPoseHeard);
    EXPECT_EQ(told.Writers, 0);
    EXPECT_EQ(told.Heard, 0u);
}

TEST_F(FastDdsMembersTest, AMemberIsNotSentATopicThatItsPermissionsLack)
{
    const auto uav = Backend().Open(SettingsOf("uav1"), {});
    const auto tool = Backend().Open(SettingsOf("tool", {{.Topic = "Pose", .MayRead = true}}), {});
    const BesideForbidden told = TalkBesideForbidden(Net(), *uav, *tool);
    ASSERT_TRUE(told.IsPoseHeard);
    EXPECT_EQ(told.Readers, 0);
}

TEST_F(FastDdsMembersTest, APeerListedOnOneSideIsEnoughWhicheverStartsFirst)
{
    auto listed = SettingsOf("uav1");
    auto listing = SettingsOf("ground");
    listed.Multicast = false;
    listing.Multicast = false;
    listing.Peers = {"127.0.0.1"};
    ExpectDelivery(listed, listing);
    ExpectDelivery(listing, listed);
}

TEST_F(FastDdsMembersTest, SharedMemoryIsRefused)
{
    auto settings = SettingsOf("uav1");
    settings.SharedMemory = true;
    ExpectRefusal(settings, "shares no memory", "shared_memory");
}

TEST_F(FastDdsMembersTest, AProfilesFileWithTransportsIsRefused)
{
    auto settings = SettingsOf("uav1");
    settings.BackendConfig = TemporaryFile(ProfileOf(R"(
    <transport_descriptors>
      <transport_descriptor>
        <transport_id>own</transport_id>
        <type>UDPv4</type>
      </transport_descriptor>
    </transport_descriptors>)",
                                                     R"(
        <userTransports><transport_id>own</transport_id></userTransports>)"));
    ExpectRefusal(settings, "has transports", "backend_config");
}

TEST_F(FastDdsMembersTest, AProfilesFileWithSecurityIsRefusedWithoutAMemberToo)
{
    auto settings = Settings("uav1");
    settings.BackendConfig = TemporaryFile(ProfileOf("", R"(
        <propertiesPolicy><properties><property>
          <name>dds.sec.auth.plugin</name><value>builtin.PKI-DH</value>
        </property></properties></propertiesPolicy>)"));
    ExpectRefusal(settings, "DDS Security", "backend_config");
    settings.Member = Fleet.Member("uav1");
    ExpectRefusal(settings, "DDS Security", "backend_config");
}

}  // namespace

}  // namespace Rabit::Conformance
