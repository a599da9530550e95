#include "Samples.h"

#include "constructs.idl.h"

#include <rabit/idl/MessageType.h>

#include <gtest/gtest.h>

namespace
{

using Bytes = std::vector<std::uint8_t>;

// One value of Basics::Stamp by hand: an octet, 7 bytes of alignment, 8 bytes.
const Bytes LittleEndian{0, 1, 0, 0, 5, 0, 0, 0, 0, 0, 0, 0, 8, 7, 6, 5, 4, 3, 2, 1};
const Bytes BigEndian{0, 0, 0, 0, 5, 0, 0, 0, 0, 0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8};

TEST(ByteOrder, WritesLittleEndian)
{
    Basics::Stamp stamp;
    stamp.node = 5;
    stamp.time_ns = 0x0102030405060708;
    EXPECT_EQ(BytesOf(stamp), LittleEndian);
}

TEST(ByteOrder, ReadsLittleEndian)
{
    Basics::Stamp stamp;
    ASSERT_TRUE(Basics::Stamp::IdlType().Deserialize(LittleEndian, stamp));
    EXPECT_EQ(stamp.node, 5);
    EXPECT_EQ(stamp.time_ns, 0x0102030405060708U);
}

TEST(ByteOrder, ReadsBigEndian)
{
    Basics::Stamp stamp;
    ASSERT_TRUE(Basics::Stamp::IdlType().Deserialize(BigEndian, stamp));
    EXPECT_EQ(stamp.node, 5);
    EXPECT_EQ(stamp.time_ns, 0x0102030405060708U);
}

TEST(ByteOrder, OptionsOfTheHeaderDoNotMatterToTheReader)
{
    Bytes bytes = LittleEndian;
    bytes[2] = 0xff;
    bytes[3] = 0xff;
    Basics::Stamp stamp;
    EXPECT_TRUE(Basics::Stamp::IdlType().Deserialize(bytes, stamp));
}

TEST(ByteOrder, PaddingIsZeroAndCountedInTheHeader)
{
    Constructs::Inner::Empty message;
    message.nothing = {9};
    EXPECT_EQ(BytesOf(message), (Bytes{0, 1, 0, 3, 1, 0, 0, 0, 9, 0, 0, 0}));
}

}  // namespace
