#include "doctor/RtpsCall.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <random>

#include "common/ParticipantIdentity.h"
#include "envelope/Outer.h"

namespace Rabit::Tool::Doctor
{
namespace
{

const ParticipantId Id{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};

// Returns a call with more parameters before its own.
std::vector<std::uint8_t> CallWith(const std::vector<std::uint8_t> &parameters)
{
    const std::vector<std::uint8_t> plain = MakeCall(Id, {10, 0, 0, 2}, 7411);
    constexpr std::ptrdiff_t firstParameter = 20 + 4 + 20 + 4;
    std::vector<std::uint8_t> call(plain.begin(), plain.begin() + firstParameter);
    std::copy(parameters.begin(), parameters.end(), std::back_inserter(call));
    std::copy(plain.begin() + firstParameter, plain.end(), std::back_inserter(call));
    const std::size_t length = call.size() - 24;
    call[22] = static_cast<std::uint8_t>(length);
    call[23] = static_cast<std::uint8_t>(length >> 8);
    return call;
}

std::vector<std::uint8_t> Parameter(std::uint8_t id, const std::string &text)
{
    std::string padded = text;
    padded.resize((text.size() + 4) / 4 * 4);
    std::vector<std::uint8_t> bytes{
        id, 0, static_cast<std::uint8_t>(padded.size() + 4), 0, static_cast<std::uint8_t>(text.size() + 1), 0,
        0,  0};
    std::copy(padded.begin(), padded.end(), std::back_inserter(bytes));
    return bytes;
}

TEST(RtpsCall, IsHeardAsAnAnnouncement)
{
    const auto heard = HeardIn(MakeCall(Id, {10, 0, 0, 2}, 7411));
    ASSERT_TRUE(heard);
    EXPECT_EQ(heard->Sender, Id);
    EXPECT_TRUE(heard->Announces);
    EXPECT_EQ(heard->Name, "");
    EXPECT_FALSE(heard->IsNode);
    EXPECT_EQ(heard->Port, 7411);
}

TEST(RtpsCall, AParticipantThatSaysThatItIsGoneAnnouncesNothing)
{
    // INFO_DST is not needed: a header and a DATA of the participant writer with PID_STATUS_INFO alone.
    std::vector<std::uint8_t> goodbye = MakeCall(Id, {10, 0, 0, 2}, 7411);
    goodbye.resize(20 + 4 + 20);
    goodbye[21] = 0x03;  // little-endian, with inline QoS, without data
    const std::vector<std::uint8_t> qos{0x71, 0, 4, 0, 0, 0, 0, 3, 1, 0, 0, 0};
    goodbye.insert(goodbye.end(), qos.begin(), qos.end());
    goodbye[22] = static_cast<std::uint8_t>(goodbye.size() - 24);
    goodbye[23] = 0;
    const auto heard = HeardIn(goodbye);
    ASSERT_TRUE(heard);
    EXPECT_EQ(heard->Sender, Id);
    EXPECT_FALSE(heard->Announces);
}

TEST(RtpsCall, IsSmall)
{
    EXPECT_LE(MakeCall(Id, {10, 0, 0, 2}, 7411).size() + 28, 220u);
}

TEST(RtpsCall, TellsANodeByItsNameAndWhatItSaysOfItself)
{
    auto parameters = Parameter(0x62, "uav1");
    const auto data = Parameter(0x2c, MakeUserData(7));
    std::copy(data.begin(), data.end(), std::back_inserter(parameters));
    const auto heard = HeardIn(CallWith(parameters));
    ASSERT_TRUE(heard);
    EXPECT_EQ(heard->Name, "uav1");
    EXPECT_TRUE(heard->IsNode);
}

TEST(RtpsCall, TellsProgramsOfRosFromOneAnother)
{
    // The name is that of the enclave, or missing.
    auto parameters = Parameter(0x62, "/");
    const auto data = Parameter(0x2c, "enclave=/;");
    std::copy(data.begin(), data.end(), std::back_inserter(parameters));
    const auto heard = HeardIn(CallWith(parameters));
    ASSERT_TRUE(heard);
    EXPECT_TRUE(heard->IsRos);
    EXPECT_EQ(LabelOf(*heard), "a program of ROS 2 (0102030405060708090a0b0c)");
}

TEST(RtpsCall, ANameIsTheLabelAndANamelessProgramHasItsPrefix)
{
    EXPECT_EQ(LabelOf(*HeardIn(CallWith(Parameter(0x62, "uav1")))), "uav1");
    EXPECT_EQ(LabelOf(*HeardIn(CallWith({}))), "a program without a name (0102030405060708090a0b0c)");
}

TEST(RtpsCall, TellsSessionsWithKeysFromOneAnother)
{
    Envelope::Outer outer{.Kind = Envelope::OuterKind::Pairwise, .Epoch = 3, .Tag = 0x01020304};
    std::vector<std::uint8_t> datagram(100);
    Envelope::WriteOuter(outer, datagram);
    EXPECT_EQ(SealedTagIn(datagram), 0x01020304U);
    outer.Tag = 5;
    Envelope::WriteOuter(outer, datagram);
    EXPECT_EQ(SealedTagIn(datagram), 5U);
    EXPECT_FALSE(HeardIn(datagram));
    EXPECT_FALSE(SealedTagIn(MakeCall(Id, {10, 0, 0, 2}, 7411)));
    EXPECT_FALSE(SealedTagIn({}));
}

TEST(RtpsCall, ASealedCallIsWhatASessionWithKeysCouldSendAndIsNotTakenForOne)
{
    const std::vector<std::uint8_t> call = MakeSealedCall();
    Envelope::Outer outer;
    EXPECT_EQ(Envelope::ReadOuter(call, outer), Envelope::OuterFault::None);
    EXPECT_EQ(outer.Epoch, Envelope::EpochOfCalls);
    EXPECT_FALSE(SealedTagIn(call));
    EXPECT_LE(call.size(), 100U);
}

TEST(RtpsCall, ANameCannotCommandATerminal)
{
    EXPECT_EQ(HeardIn(CallWith(Parameter(0x62, "a\x1b[2J\n")))->Name, "a?[2J?");
    EXPECT_EQ(HeardIn(CallWith(Parameter(0x62, std::string(200, 'x'))))->Name, std::string(64, 'x'));
}

TEST(RtpsCall, WhatIsNotOfRtpsIsNothing)
{
    EXPECT_FALSE(HeardIn({}));
    EXPECT_FALSE(HeardIn(std::vector<std::uint8_t>(100, 'R')));
}

TEST(RtpsCall, DamagedOnesAreReadWithinTheirBytes)
{
    const auto good = CallWith(Parameter(0x62, "uav1"));
    std::mt19937 random(1);
    for (int round = 0; round < 20000; ++round)
    {
        auto bad = good;
        for (int i = 0; i < 3; ++i)
        {
            bad[random() % bad.size()] = static_cast<std::uint8_t>(random());
        }
        bad.resize(random() % 4 == 0 ? random() % bad.size() : bad.size());
        const auto heard = HeardIn(bad);
        EXPECT_TRUE(!heard || heard->Name.size() <= 64);
    }
}

}  // namespace
}  // namespace Rabit::Tool::Doctor
