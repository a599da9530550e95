#include "Samples.h"

#include "keys.idl.h"
#include "uav.idl.h"

#include <rabit/idl/MessageType.h>
#include <rabit/idl/MessageTypeRegistry.h>

#include <gtest/gtest.h>

#include <cstdio>

namespace
{

std::string Hex(const std::array<std::uint8_t, 16> &bytes)
{
    std::string text;
    for (const std::uint8_t byte : bytes)
    {
        char digits[3];
        std::snprintf(digits, sizeof digits, "%02x", byte);
        text += digits;
    }
    return text;
}

std::string HashOf(const Rabit::RabitMessage &message)
{
    std::array<std::uint8_t, 16> hash{};
    const Rabit::MessageType *type = Rabit::MessageTypeRegistry::Of(message);
    return type->KeyHashOf(BytesOf(message), hash) ? Hex(hash) : "refused";
}

std::string HashOfSample(const std::string &name)
{
    for (const Sample &sample : AllSamples())
    {
        if (sample.Name == name)
        {
            return HashOf(*sample.Message);
        }
    }
    return "no such sample";
}

// A key of at most 16 bytes is its own hash: big endian, aligned, filled up with zeros.
TEST(KeyHash, ShortKeyIsTheKeyItself)
{
    EXPECT_EQ(HashOfSample("ShortKey"), "01000000fffffffe0003000000000000");
}

TEST(KeyHash, KeyOfExactlySixteenBytesIsTheKeyItself)
{
    EXPECT_EQ(HashOfSample("ExactKey"), "fffffffffffffffffffffffffffffffe");
}

TEST(KeyHash, BoundedStringThatAlwaysFitsIsTheKeyItself)
{
    EXPECT_EQ(HashOfSample("BoundedTextKey"), "0000000c6c6576656e20627974657300");
}

TEST(KeyHash, NestedKeyIsMadeOfTheNestedKeyMembers)
{
    // zone 0007, letter 7a, then all of Plain: flag 01, real 3fc00000.
    EXPECT_EQ(HashOfSample("NestedKey"), "00077a013fc000000000000000000000");
}

TEST(KeyHash, KeyOfABaseCounts)
{
    EXPECT_EQ(HashOfSample("DerivedKey"), "00000005000000000000000000000000");
}

TEST(KeyHash, ArrayKeyIsAllOfItsElements)
{
    EXPECT_EQ(HashOfSample("ArrayKey"), "00010002000300040005000600000001");
}

// MD5 as `printf ... | md5sum` gives it for these bytes.
TEST(KeyHash, LongerKeyIsHashed)
{
    // 01, 7 bytes of alignment, 0000000000000002, 03
    EXPECT_EQ(HashOfSample("LongKey"), "d7d5d9a443309261ea29bc5625de3d0a");
}

TEST(KeyHash, UnboundedStringIsAlwaysHashed)
{
    // 00000005 "name" 00
    EXPECT_EQ(HashOfSample("TextKey"), "ea53cb8f5ab1ea1b73c9646522db3441");
}

TEST(KeyHash, BoundedStringThatMayNotFitIsAlwaysHashed)
{
    // 00000002 "x" 00
    EXPECT_EQ(HashOfSample("WideBoundedTextKey"), "b5445fe60b0bf1179ea5d24fc85a2e29");
}

TEST(KeyHash, MembersThatAreNotKeysDoNotMatter)
{
    Keys::ShortKey a;
    Keys::ShortKey b;
    b.before = "something";
    b.between = {1.0, 2.0};
    b.after = 3.0;
    EXPECT_EQ(HashOf(a), HashOf(b));
}

TEST(KeyHash, ByteOrderOfTheSampleDoesNotMatter)
{
    std::array<std::uint8_t, 16> hash{};
    Keys::BaseKey message;
    message.id = 1;
    message.text = "";
    const std::vector<std::uint8_t> bytes{0, 0, 0, 3, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0};
    ASSERT_TRUE(Keys::BaseKey::IdlType().KeyHashOf(bytes, hash));
    EXPECT_EQ(Hex(hash), HashOf(message));
}

TEST(KeyHash, TypeWithoutKeyHasNone)
{
    EXPECT_FALSE(Uav::Pose::IdlType().HasKey());
    EXPECT_EQ(HashOf(Uav::Pose()), "refused");
}

}  // namespace
