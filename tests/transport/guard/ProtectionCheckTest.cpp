// Whether the submessages that DDS Security puts around others are complete.
#include "guard/ProtectionCheck.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "guard/RtpsBytes.h"

namespace
{

using namespace RtpsBytes;
using Rabit::Rtps::Proof;
using Rabit::Rtps::ProtectedSize;

constexpr std::uint8_t Body = 0x30;
constexpr std::uint8_t Postfix = 0x32;
constexpr std::uint8_t MessagePrefix = 0x33;
constexpr std::uint8_t MessagePostfix = 0x34;

Bytes BigEndian(std::uint32_t value)
{
    return {static_cast<std::uint8_t>(value >> 24), static_cast<std::uint8_t>(value >> 16),
            static_cast<std::uint8_t>(value >> 8), static_cast<std::uint8_t>(value)};
}

Bytes Prefix(std::uint8_t kind = SecurePrefix)
{
    return Submessage(kind, Bytes(20, 7));
}

Bytes Tag(std::uint8_t kind = Postfix, std::uint32_t said = 0, std::size_t there = 0)
{
    return Submessage(kind, Join({Bytes(16, 9), BigEndian(said), Bytes(20 * there, 5)}));
}

Bytes Sealed(std::uint32_t said, std::size_t there)
{
    return Submessage(Body, Join({BigEndian(said), Bytes(there, 3)}));
}

bool IsWhole(Bytes bytes, bool wholeMessage = false, Proof proof = Proof::OfMember)
{
    return ProtectedSize(bytes, wholeMessage, proof, [](const auto &) { return true; }) == bytes.size();
}

bool IsUnsound(Bytes bytes, bool wholeMessage = false, Proof proof = Proof::OfMember)
{
    return !ProtectedSize(bytes, wholeMessage, proof, [](const auto &) { return true; });
}

TEST(ProtectionCheck, AnEncryptedOrSignedSubmessageIsPrefixContentAndTag)
{
    EXPECT_TRUE(IsWhole(Join({Prefix(), Sealed(40, 40), Tag()})));
    EXPECT_TRUE(IsWhole(Join({Prefix(), Sealed(38, 40), Tag(Postfix, 2, 2)})));
    EXPECT_TRUE(IsWhole(Join({Prefix(), Submessage(Data, DataBody(1), 5), Tag()})));
}

TEST(ProtectionCheck, WhatFollowsTheTagIsLeftToTheCaller)
{
    Bytes group = Join({Prefix(), Sealed(40, 40), Tag()});
    const std::size_t size = group.size();
    group = Join({group, Submessage(Data, DataBody(1), 5)});
    EXPECT_EQ(ProtectedSize(group, false, Proof::OfMember, [](const auto &) { return true; }), size);
}

TEST(ProtectionCheck, AWholeMessageIsProtectedBehindTheHeaderAlone)
{
    const Bytes message = Join({Prefix(MessagePrefix), Source(Sender), Submessage(Data, DataBody(1), 5),
                                Prefix(), Sealed(40, 40), Tag(), Tag(MessagePostfix)});
    EXPECT_TRUE(IsWhole(message, true));
    EXPECT_TRUE(IsUnsound(message, false));
    EXPECT_TRUE(IsWhole(Join({Prefix(MessagePrefix), Sealed(40, 40), Tag(MessagePostfix)}), true));
}

TEST(ProtectionCheck, TheCallerDecidesAboutWhatTheKeyOfTheMessageAloneProtects)
{
    const auto asked = [](Bytes bytes, std::uint8_t refused)
    {
        std::vector<std::uint8_t> kinds;
        const bool sound = ProtectedSize(bytes, true, Proof::OfMember,
                                         [&](const Rabit::Rtps::Submessage &part)
                                         {
                                             kinds.push_back(part.Whole[0]);
                                             return part.Whole[0] != refused;
                                         })
                               .has_value();
        return std::pair(sound, kinds);
    };
    const Bytes plain = Join({Prefix(MessagePrefix), Source(Sender), Prefix(), Sealed(40, 40), Tag(),
                              Submessage(Data, DataBody(1), 5), Tag(MessagePostfix)});
    EXPECT_EQ(asked(plain, 0), std::pair(true, std::vector<std::uint8_t>{InfoSource, Data}));
    EXPECT_EQ(asked(plain, Data), std::pair(false, std::vector<std::uint8_t>{InfoSource, Data}));
    const Bytes encrypted = Join({Prefix(MessagePrefix), Sealed(40, 40), Tag(MessagePostfix)});
    EXPECT_EQ(asked(encrypted, 0), std::pair(true, std::vector<std::uint8_t>{Body}));
    EXPECT_EQ(asked(encrypted, Body), std::pair(false, std::vector<std::uint8_t>{Body}));
}

TEST(ProtectionCheck, AGroupHasOneSubmessageOfAWriterOrReaderOrItsTime)
{
    EXPECT_TRUE(IsWhole(Join({Prefix(), Submessage(InfoTimestamp, Bytes(8)), Tag()})));
    EXPECT_TRUE(IsUnsound(Join({Prefix(), Source(Sender), Tag()})));
    EXPECT_TRUE(
        IsUnsound(Join({Prefix(MessagePrefix), Prefix(), Source(Sender), Tag(), Tag(MessagePostfix)}), true));
}

// Each member holds the common key of each other one. Fast DDS asks for a receiver's own tag only if the
// message has some.
TEST(ProtectionCheck, TheSenderIsProvenByTheTagOfAReceiverAlone)
{
    const auto message = [](const Bytes &tag) {
        return Join({Prefix(MessagePrefix), Prefix(), Sealed(40, 40), Tag(), tag});
    };
    const auto encrypted = [](const Bytes &tag) {
        return Join({Prefix(MessagePrefix), Sealed(40, 40), tag});
    };
    for (const Bytes &whole : {message(Tag(MessagePostfix, 2, 2)), encrypted(Tag(MessagePostfix, 1, 1))})
    {
        EXPECT_TRUE(IsWhole(whole, true, Proof::OfSender));
    }
    for (const Bytes &whole : {message(Tag(MessagePostfix)), encrypted(Tag(MessagePostfix))})
    {
        EXPECT_TRUE(IsWhole(whole, true, Proof::OfMember));
        EXPECT_TRUE(IsUnsound(whole, true, Proof::OfSender));
    }
}

// The vendor finds the key 0 where a sender has no key for a receiver; the salt alone makes it.
TEST(ProtectionCheck, ATagUnderTheKeyZeroProvesNoSender)
{
    Bytes tag = Tag(MessagePostfix, 2, 2);
    const std::size_t last = tag.size() - 20;
    std::fill_n(tag.begin() + static_cast<std::ptrdiff_t>(last), 3, std::uint8_t{0});
    const auto message = [&] { return Join({Prefix(MessagePrefix), Sealed(40, 40), tag}); };
    EXPECT_TRUE(IsWhole(message(), true, Proof::OfSender));
    tag[last + 3] = 0;
    EXPECT_TRUE(IsUnsound(message(), true, Proof::OfSender));
}

// A unit of its own is not signed by its sender, unless its key is that of two participants.
TEST(ProtectionCheck, OutsideOfAMessageTheKeyZeroAloneProvesTheSender)
{
    Bytes prefix = Prefix();
    const auto unit = [&] { return Join({prefix, Sealed(40, 40), Tag(Postfix, 1, 1)}); };
    EXPECT_TRUE(IsUnsound(unit(), false, Proof::OfSender));
    EXPECT_TRUE(IsUnsound(unit(), true, Proof::OfSender));
    std::fill_n(prefix.begin() + 4 + 4, 3, std::uint8_t{0});
    EXPECT_TRUE(IsUnsound(unit(), true, Proof::OfSender));
    prefix[4 + 4 + 3] = 0;
    EXPECT_TRUE(IsWhole(unit(), false, Proof::OfSender));
    EXPECT_TRUE(IsWhole(unit(), true, Proof::OfSender));
}

// The vendor adds up lengths that do not fit. It read a gigabyte from a datagram of a few hundred bytes: a
// segmentation fault, before any signature was checked.
TEST(ProtectionCheck, LengthsBeyondTheDatagramAreUnsound)
{
    Bytes long1 = Submessage(Data, DataBody(1), 5);
    long1[2] = long1[3] = 0xff;
    EXPECT_TRUE(IsUnsound(Join({Prefix(MessagePrefix), long1, Tag(MessagePostfix)}), true));
    EXPECT_TRUE(IsUnsound(Join({Prefix(), long1, Tag()})));
    EXPECT_TRUE(IsUnsound(Join({Prefix(), Sealed(44, 40), Tag()})));
    EXPECT_TRUE(IsUnsound(Join({Prefix(), Sealed(0xffffffff, 40), Tag()})));
    EXPECT_TRUE(IsUnsound(Join({Prefix(MessagePrefix), Sealed(0x10000000, 40), Tag(MessagePostfix)}), true));
}

TEST(ProtectionCheck, APrefixOfAnotherSizeIsUnsound)
{
    EXPECT_TRUE(IsUnsound(Join({Submessage(SecurePrefix, Bytes(16)), Sealed(40, 40), Tag()})));
    EXPECT_TRUE(IsUnsound(Join({Submessage(SecurePrefix, Bytes(24)), Sealed(40, 40), Tag()})));
}

TEST(ProtectionCheck, ATagHasAsManyReceiversAsItSays)
{
    EXPECT_TRUE(IsUnsound(Join({Prefix(), Sealed(40, 40), Tag(Postfix, 2, 1)})));
    EXPECT_TRUE(IsUnsound(Join({Prefix(), Sealed(40, 40), Tag(Postfix, 0x0ccccccd, 1)})));
    EXPECT_TRUE(IsUnsound(Join({Prefix(), Sealed(40, 40), Submessage(Postfix, Bytes(16))})));
}

TEST(ProtectionCheck, WithoutATagOrWithTheOtherOneItIsUnsound)
{
    EXPECT_TRUE(IsUnsound(Prefix()));
    EXPECT_TRUE(IsUnsound(Prefix(MessagePrefix), true));
    EXPECT_TRUE(IsUnsound(Join({Prefix(), Sealed(40, 40)})));
    EXPECT_TRUE(IsUnsound(Join({Prefix(), Sealed(40, 40), Tag(MessagePostfix)})));
    EXPECT_TRUE(IsUnsound(Join({Prefix(MessagePrefix), Sealed(40, 40)}), true));
    EXPECT_TRUE(IsUnsound(Join({Prefix(MessagePrefix), Submessage(Data, DataBody(1), 5)}), true));
    EXPECT_TRUE(IsUnsound(Join({Prefix(MessagePrefix), Tag(MessagePostfix)}), true));
}

// The vendor looks for statistics everywhere, and its assertion at RTPSStatisticsMessages.hpp:128 fails.
TEST(ProtectionCheck, StatisticsWithinAreUnsound)
{
    const Bytes statistics = Submessage(Statistics, Bytes(56));
    EXPECT_TRUE(IsUnsound(Join({Prefix(), statistics, Tag()})));
    EXPECT_TRUE(IsUnsound(Join({Prefix(MessagePrefix), statistics, Tag(MessagePostfix)}), true));
    EXPECT_TRUE(
        IsUnsound(Join({Prefix(MessagePrefix), Prefix(), statistics, Tag(), Tag(MessagePostfix)}), true));
}

TEST(ProtectionCheck, ATagSaysHowLongItIs)
{
    Bytes tag = Tag();
    tag[2] = 0;
    EXPECT_TRUE(IsUnsound(Join({Prefix(), Sealed(40, 40), tag})));
}

TEST(ProtectionCheck, PartsOfItAloneAreUnsound)
{
    EXPECT_TRUE(IsUnsound(Sealed(40, 40)));
    EXPECT_TRUE(IsUnsound(Tag()));
    EXPECT_TRUE(IsUnsound(Join({Prefix(), Prefix(), Sealed(40, 40), Tag(), Tag()})));
}

}  // namespace
