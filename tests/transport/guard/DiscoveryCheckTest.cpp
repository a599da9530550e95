// Which announcements of participants and endpoints are sound.
#include "guard/DiscoveryCheck.h"

#include <gtest/gtest.h>

#include <string>

#include "guard/DeliveryCheck.h"
#include "guard/RtpsBytes.h"

namespace
{

using namespace RtpsBytes;
using namespace Rabit::Rtps;

bool IsSound(EntityId topic, Bytes payload)
{
    return CheckDiscovery(topic, Sender, payload).has_value();
}

// A writer's announcement with one more parameter.
bool IsSoundWith(std::uint16_t id, const Bytes &value)
{
    Bytes payload = WriterData();
    payload.resize(payload.size() - 4);
    return IsSound(PublicationsWriter, Join({payload, Parameter(id, value), {1, 0, 0, 0}}));
}

TEST(DiscoveryCheck, SoundAnnouncementsPass)
{
    Bytes participant = ParticipantData();
    const auto about = CheckDiscovery(ParticipantWriter, Sender, participant);
    ASSERT_TRUE(about);
    EXPECT_EQ(about->Subject, ParticipantEntity);
    EXPECT_NE(about->Digest, 0u);

    Bytes writer = WriterData(0x00000203);
    const auto endpoint = CheckDiscovery(PublicationsWriter, Sender, writer);
    ASSERT_TRUE(endpoint);
    EXPECT_EQ(endpoint->Subject, 0x00000203u);
    EXPECT_TRUE(IsSound(SubscriptionsWriter, WriterData(UserReader)));
}

// The vendor enters such a participant under the name in the data. When its lease ends, an assertion fails.
TEST(DiscoveryCheck, AParticipantSpeaksOfItselfAlone)
{
    EXPECT_FALSE(IsSound(ParticipantWriter, ParticipantData(Other)));
    EXPECT_FALSE(IsSound(ParticipantWriter, ParticipantData(GuidPrefix{})));
}

TEST(DiscoveryCheck, AnEndpointIsOfTheSenderAndOfTheKindOfItsTopic)
{
    EXPECT_FALSE(IsSound(PublicationsWriter, WriterData(UserWriter, Other)));
    EXPECT_FALSE(IsSound(PublicationsWriter, WriterData(UserReader)));
    EXPECT_FALSE(IsSound(SubscriptionsWriter, WriterData(UserWriter)));
    EXPECT_FALSE(IsSound(PublicationsWriter, WriterData(0x000003c2)));
    EXPECT_FALSE(IsSoundWith(0x0050, Guid(Other, ParticipantEntity)));
    EXPECT_FALSE(IsSoundWith(0x005a, Guid(Sender, 0x00000203)));
    EXPECT_FALSE(IsSoundWith(0x0070, Guid(Sender, 0x00000203)));
    EXPECT_TRUE(IsSoundWith(0x0070, Guid(Sender, UserWriter)));
}

TEST(DiscoveryCheck, WhatIsMissingIsNotGuessed)
{
    const Bytes guid = Parameter(0x0050, Guid(Sender, ParticipantEntity));
    const Bytes lease = Parameter(0x0002, Join({U32(3), U32(0)}));
    EXPECT_TRUE(IsSound(ParticipantWriter, List({guid, lease})));
    EXPECT_FALSE(IsSound(ParticipantWriter, List({guid})));
    EXPECT_FALSE(IsSound(ParticipantWriter, List({lease})));
    const Bytes endpoint = Parameter(0x005a, Guid(Sender, UserWriter));
    const Bytes topic = Parameter(0x0005, Text("Pose"));
    EXPECT_FALSE(IsSound(PublicationsWriter, List({endpoint, topic})));
    EXPECT_FALSE(IsSound(PublicationsWriter, List({topic, Parameter(0x0007, Text("T"))})));
}

TEST(DiscoveryCheck, ALeaseOfNothingIsUnsound)
{
    const auto with = [](std::uint32_t seconds, std::uint32_t fraction)
    {
        return List({Parameter(0x0050, Guid(Sender, ParticipantEntity)),
                     Parameter(0x0002, Join({U32(seconds), U32(fraction)}))});
    };
    EXPECT_FALSE(IsSound(ParticipantWriter, with(0, 0)));
    EXPECT_FALSE(IsSound(ParticipantWriter, with(0x80000000, 0)));
    EXPECT_TRUE(IsSound(ParticipantWriter, with(0, 0x80000000)));
}

// Otherwise a forged participant is sent to for ever.
TEST(DiscoveryCheck, ALeaseIsCutToTheLongestOne)
{
    const auto with = [](std::uint32_t seconds, std::uint32_t fraction)
    {
        return List({Parameter(0x0050, Guid(Sender, ParticipantEntity)),
                     Parameter(0x0002, Join({U32(seconds), U32(fraction)}))});
    };
    const auto longest = static_cast<std::uint32_t>(LongestLease.count());
    const auto left = [](Bytes payload, Lease lease = Lease::Bounded)
    {
        EXPECT_TRUE(CheckDiscovery(ParticipantWriter, Sender, payload, lease));
        return payload;
    };
    EXPECT_EQ(left(with(0x7fffffff, 0xffffffff)), with(longest, 0));
    EXPECT_EQ(left(with(longest, 1)), with(longest, 0));
    EXPECT_EQ(left(with(longest, 0)), with(longest, 0));
    EXPECT_EQ(left(with(100, 7)), with(100, 7));
    EXPECT_EQ(left(with(4 * 3600, 0), Lease::OfCard), with(4 * 3600, 0));
}

TEST(DiscoveryCheck, EveryTruncationIsUnsound)
{
    for (const auto &[topic, payload] :
         {std::pair(ParticipantWriter, ParticipantData()), std::pair(PublicationsWriter, WriterData())})
    {
        for (std::size_t size = 0; size < payload.size(); ++size)
        {
            EXPECT_FALSE(
                IsSound(topic, Bytes(payload.begin(), payload.begin() + static_cast<std::ptrdiff_t>(size))))
                << size;
        }
    }
}

TEST(DiscoveryCheck, StringsEndWhereTheySay)
{
    EXPECT_TRUE(IsSoundWith(0x0005, Text("Pose")));
    EXPECT_FALSE(IsSoundWith(0x0005, {5, 0, 0, 0, 'P', 'o', 's', 'e', 's', 0, 0, 0}));
    EXPECT_FALSE(IsSoundWith(0x0005, {0, 0, 0, 0}));
    EXPECT_FALSE(IsSoundWith(0x0005, Join({U32(0xffffffff), Text("Pose")})));
    EXPECT_TRUE(IsSoundWith(0x0005, Text(std::string(255, 'a').c_str())));
    EXPECT_FALSE(IsSoundWith(0x0005, Text(std::string(256, 'a').c_str())));
}

TEST(DiscoveryCheck, ListsHaveAsManyEntriesAsTheySay)
{
    EXPECT_TRUE(IsSoundWith(0x0029, Join({U32(2), Text("uav1"), Text("")})));
    EXPECT_FALSE(IsSoundWith(0x0029, Join({U32(3), Text("uav1"), Text("")})));
    EXPECT_FALSE(IsSoundWith(0x0029, Join({U32(1), Text("uav1"), Text("")})));
    EXPECT_FALSE(IsSoundWith(0x0029, Join({U32(0xffffffff), Text("uav1")})));
}

// The vendor appends as many representations as the count says, present or not.
TEST(DiscoveryCheck, RepresentationsAreAsManyAsTheySay)
{
    EXPECT_TRUE(IsSoundWith(0x0073, Join({U32(1), U16(0), U16(0)})));
    EXPECT_TRUE(IsSoundWith(0x0073, Join({U32(2), U16(0), U16(2)})));
    EXPECT_FALSE(IsSoundWith(0x0073, Join({U32(0xffffffff), U16(0), U16(0)})));
    EXPECT_FALSE(IsSoundWith(0x0073, Join({U32(3), U16(0), U16(0)})));
}

TEST(DiscoveryCheck, DataOfTheUserIsAsLongAsItSays)
{
    EXPECT_TRUE(IsSoundWith(0x002c, Join({U32(3), {1, 2, 3, 0}})));
    EXPECT_FALSE(IsSoundWith(0x002c, Join({U32(5), {1, 2, 3, 0}})));
    EXPECT_FALSE(IsSoundWith(0x002c, Join({U32(0xffffffff), {1, 2, 3, 0}})));
}

TEST(DiscoveryCheck, NumbersHaveTheirSize)
{
    EXPECT_TRUE(IsSoundWith(0x001a, Bytes(12)));
    EXPECT_FALSE(IsSoundWith(0x001a, Bytes(8)));
    EXPECT_FALSE(IsSoundWith(0x001d, Bytes(8)));
    EXPECT_FALSE(IsSoundWith(0x001e, Bytes(24)));
    EXPECT_FALSE(IsSoundWith(0x0050, Bytes(12)));
    EXPECT_FALSE(IsSoundWith(0x002f, Bytes(20)));
}

TEST(DiscoveryCheck, APortIsAPort)
{
    EXPECT_TRUE(IsSoundWith(0x002f, Join({U32(1), U32(65535), Bytes(16)})));
    EXPECT_FALSE(IsSoundWith(0x002f, Join({U32(1), U32(65536), Bytes(16)})));
    EXPECT_FALSE(IsSoundWith(0x002f, Join({U32(2), U32(65536), Bytes(16)})));
    EXPECT_FALSE(IsSoundWith(0x002f, Join({U32(1), U32(0), Bytes(16)})));
}

// TCP locators have two port numbers there: 4 is TCPv4.
TEST(DiscoveryCheck, ALocatorOfAnotherKindHasNoPortOfUdp)
{
    EXPECT_TRUE(IsSoundWith(0x002f, Join({U32(4), U32(0x1c501c50), Bytes(16)})));
    EXPECT_TRUE(IsSoundWith(0x002f, Join({U32(16), U32(0), Bytes(16)})));
}

TEST(DiscoveryCheck, ThereAreNotEndlesslyManyParametersOrLocators)
{
    const auto with = [](int count, const Bytes &parameter)
    {
        Bytes payload = WriterData();
        payload.resize(payload.size() - 4);
        for (int i = 0; i < count; ++i)
        {
            payload = Join({payload, parameter});
        }
        return IsSound(PublicationsWriter, Join({payload, {1, 0, 0, 0}}));
    };
    const Bytes locator = Parameter(0x002f, Join({U32(1), U32(7411), Bytes(16)}));
    EXPECT_TRUE(with(64, locator));
    EXPECT_FALSE(with(65, locator));
    EXPECT_TRUE(with(120, Parameter(0x4000, {})));
    EXPECT_FALSE(with(128, Parameter(0x4000, {})));
}

TEST(DiscoveryCheck, WhatWeHaveNoUseForIsBlanked)
{
    constexpr std::uint16_t TypeObject = 0x0072;
    constexpr std::uint16_t EndpointSecurityInfo = 0x1004;  // of DDS Security
    Bytes payload = WriterData();
    const std::size_t at = payload.size() - 4;
    payload.resize(at);
    const Bytes object = Parameter(TypeObject, Bytes(64, 7));
    payload = Join({payload, object, Parameter(EndpointSecurityInfo, Bytes(8, 7)), {1, 0, 0, 0}});
    const auto nameAt = [&](std::size_t where)
    {
        const auto begin = payload.begin() + static_cast<std::ptrdiff_t>(where);
        return Bytes(begin, begin + 4);
    };
    ASSERT_TRUE(CheckDiscovery(PublicationsWriter, Sender, payload));
    EXPECT_EQ(nameAt(at), (Bytes{0, 0, 64, 0}));
    EXPECT_EQ(nameAt(at + object.size()), (Bytes{0, 0, 8, 0}));
}

TEST(DiscoveryCheck, OnlyAListOfParametersIsAnAnnouncement)
{
    for (const std::uint8_t encapsulation : std::initializer_list<std::uint8_t>{0, 1, 4, 7, 255})
    {
        Bytes payload = WriterData();
        payload[1] = encapsulation;
        EXPECT_FALSE(IsSound(PublicationsWriter, payload)) << int{encapsulation};
    }
    Bytes payload = WriterData();
    payload[0] = 1;
    EXPECT_FALSE(IsSound(PublicationsWriter, payload));
}

TEST(DiscoveryCheck, TheDigestIsOfWhereAParticipantIsHeard)
{
    const auto digest = [](Bytes payload)
    { return CheckDiscovery(ParticipantWriter, Sender, payload)->Digest; };
    EXPECT_EQ(digest(ParticipantData(Sender, 7410)), digest(ParticipantData(Sender, 7410)));
    EXPECT_NE(digest(ParticipantData(Sender, 7410)), digest(ParticipantData(Sender, 7412)));
}

TEST(DiscoveryCheck, AParticipantListensToAGroupIfItAnnouncesOneForSamples)
{
    constexpr std::uint16_t MetatrafficMulticastLocator = 0x0033;
    constexpr std::uint16_t DefaultMulticastLocator = 0x0048;
    const auto listens = [](std::uint16_t locator)
    {
        Bytes payload = ParticipantData();
        payload.resize(payload.size() - 4);
        payload = Join({payload,
                        Parameter(locator, Join({U32(1), U32(7401), Bytes(12), {239, 255, 0, 1}})),
                        {1, 0, 0, 0}});
        return CheckDiscovery(ParticipantWriter, Sender, payload)->ListensToGroup;
    };
    EXPECT_TRUE(listens(DefaultMulticastLocator));
    EXPECT_FALSE(listens(MetatrafficMulticastLocator));
}

TEST(DiscoveryCheck, LivelinessIsTheSendersOwn)
{
    const Bytes own = Join({{0, 1, 0, 0}, Bytes(Sender.begin(), Sender.end()), {0, 0, 0, 1}, U32(0)});
    EXPECT_TRUE(IsSound(LivelinessWriter, own));
    const Bytes another = Join({{0, 1, 0, 0}, Bytes(Other.begin(), Other.end()), {0, 0, 0, 1}, U32(0)});
    EXPECT_FALSE(IsSound(LivelinessWriter, another));
    EXPECT_FALSE(IsSound(LivelinessWriter, Bytes(own.begin(), own.begin() + 20)));
}

}  // namespace
