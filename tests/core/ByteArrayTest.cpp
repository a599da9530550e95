#include <rabit/ByteArrayReaderWriter.h>

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace
{

using namespace Rabit;

class BothOrders : public testing::TestWithParam<EndianOrder_e>
{
};

TEST_P(BothOrders, WhatIsWrittenIsRead)
{
    std::array<std::uint8_t, 200> buffer{};
    ByteArrayWriter writer(buffer.data(), 200, GetParam());
    EXPECT_FALSE(writer.writeByte(1));
    EXPECT_FALSE(writer.writeBool(true));
    EXPECT_FALSE(writer.writeChar('c'));
    EXPECT_FALSE(writer.writeInt8(-8));
    EXPECT_FALSE(writer.writeUInt8(200));
    EXPECT_FALSE(writer.writeInt16(-1600));
    EXPECT_FALSE(writer.writeUInt16(60000));
    EXPECT_FALSE(writer.writeInt32(-320000000));
    EXPECT_FALSE(writer.writeUInt32(4000000000u));
    EXPECT_FALSE(writer.writeInt64(-6400000000000000000));
    EXPECT_FALSE(writer.writeUInt64(18000000000000000000u));
    EXPECT_FALSE(writer.writeFloat(1.5f));
    EXPECT_FALSE(writer.writeDouble(-2.25));
    EXPECT_FALSE(writer.writeString("text"));
    EXPECT_FALSE(writer.writeString("other", 3));
    EXPECT_EQ(writer.Idx, 1 + 1 + 1 + 1 + 1 + 2 + 2 + 4 + 4 + 8 + 8 + 4 + 8 + 6 + 5);
    EXPECT_EQ(writer.GetNumberBytesAvailable(), 200 - writer.Idx);
    EXPECT_EQ(writer.GetByteArrayAddrPtrAtIdx(), buffer.data() + writer.Idx);
    ByteArrayReader reader(buffer.data(), writer.Idx, GetParam());
    EXPECT_EQ(reader.readByte(), 1);
    EXPECT_TRUE(reader.readBool());
    EXPECT_EQ(reader.readChar(), 'c');
    EXPECT_EQ(reader.readInt8(), -8);
    EXPECT_EQ(reader.readUInt8(), 200);
    EXPECT_EQ(reader.readInt16(), -1600);
    EXPECT_EQ(reader.readUInt16(), 60000);
    EXPECT_EQ(reader.readInt32(), -320000000);
    EXPECT_EQ(reader.readUInt32(), 4000000000u);
    EXPECT_EQ(reader.readInt64(), -6400000000000000000);
    EXPECT_EQ(reader.readUInt64(), 18000000000000000000u);
    EXPECT_EQ(reader.readFloat(), 1.5f);
    EXPECT_EQ(reader.readDouble(), -2.25);
    EXPECT_EQ(reader.readString(), "text");
    std::array<char, 10> text{};
    EXPECT_FALSE(reader.readString(text.data(), 10));
    EXPECT_STREQ(text.data(), "oth");
    EXPECT_EQ(reader.GetNumberBytesAvailable(), 0);
}

INSTANTIATE_TEST_SUITE_P(ByteArray, BothOrders, testing::Values(Endian_Little, Endian_Big));

TEST(ByteArray, TheOrderOfTheBytesIsTheOneAskedFor)
{
    std::array<std::uint8_t, 4> buffer{};
    ByteArrayWriter big(buffer.data(), 4, Endian_Big);
    big.writeUInt32(0x01020304);
    EXPECT_EQ(buffer, (std::array<std::uint8_t, 4>{1, 2, 3, 4}));
    ByteArrayWriter little(buffer.data(), 4, Endian_Little);
    little.writeUInt32(0x01020304);
    EXPECT_EQ(buffer, (std::array<std::uint8_t, 4>{4, 3, 2, 1}));
}

TEST(ByteArray, AValueThatDoesNotFitIsAnErrorAndNothingIsWritten)
{
    std::array<std::uint8_t, 3> buffer{};
    ByteArrayWriter writer(buffer.data(), 3, Endian_Big);
    EXPECT_TRUE(writer.writeInt32(-1));
    EXPECT_EQ(writer.Idx, 0);
    EXPECT_EQ(buffer, (std::array<std::uint8_t, 3>{}));
}

TEST(ByteArray, AStringNeedsRoomForItsLengthToo)
{
    std::array<std::uint8_t, 5> buffer{};
    ByteArrayWriter writer(buffer.data(), 5, Endian_Big);
    EXPECT_TRUE(writer.writeString("four"));
    EXPECT_EQ(writer.Idx, 0);
    EXPECT_FALSE(writer.writeString("333"));
    EXPECT_TRUE(writer.writeString(""));
    ByteArrayWriter large(buffer.data(), 5, Endian_Big);
    EXPECT_TRUE(large.writeString(std::string(65536, 'x')));
}

TEST(ByteArray, AnEmptyStringAtTheEndIsRead)
{
    std::array<std::uint8_t, 2> buffer{};
    std::string text = "before";
    ByteArrayReader reader(buffer.data(), 2, Endian_Big);
    EXPECT_FALSE(reader.readString(&text));
    EXPECT_EQ(text, "");
    EXPECT_EQ(reader.Idx, 2);
}

TEST(ByteArray, AStringThatIsLongerThanTheBufferIsNotRead)
{
    std::array<std::uint8_t, 4> buffer{0, 200, 'a', 'b'};
    ByteArrayReader reader(buffer.data(), 4, Endian_Big);
    std::string text = "before";
    std::array<char, 300> array{};
    EXPECT_EQ(reader.readString(), "");
    EXPECT_TRUE(reader.readString(&text));
    EXPECT_TRUE(reader.readString(array.data(), 300));
    EXPECT_EQ(text, "before");
    EXPECT_EQ(reader.Idx, 0);
}

TEST(ByteArray, AStringThatDoesNotFitTheArrayIsNotRead)
{
    std::array<std::uint8_t, 4> buffer{0, 2, 'a', 'b'};
    ByteArrayReader reader(buffer.data(), 4, Endian_Big);
    std::array<char, 3> array{'x', 'x', 'x'};
    EXPECT_TRUE(reader.readString(array.data(), 2));
    EXPECT_EQ(array[0], 'x');
    EXPECT_FALSE(reader.readString(array.data(), 3));
    EXPECT_STREQ(array.data(), "ab");
}

TEST(ByteArray, ReadingPastTheEndGivesZero)
{
    std::array<std::uint8_t, 3> buffer{1, 2, 3};
    ByteArrayReader reader(buffer.data(), 3, Endian_Big);
    EXPECT_EQ(reader.readInt32(), 0);
    EXPECT_EQ(reader.readDouble(), 0.0);
    EXPECT_EQ(reader.readUInt16(), 0x0102);
    EXPECT_EQ(reader.readInt16(), 0);
    EXPECT_EQ(reader.readByte(), 3);
    EXPECT_EQ(reader.readByte(), 0);
    reader.Clear();
    EXPECT_EQ(reader.readByte(), 1);
}

TEST(ByteArray, CopiesBytesAsFarAsSourceAndBufferGo)
{
    std::array<std::uint8_t, 4> buffer{};
    std::array<std::uint8_t, 5> source{1, 2, 3, 4, 5};
    ByteArrayWriter writer(buffer.data(), 4, Endian_Big);
    EXPECT_EQ(writer.WriteBytes(source.data(), 5, 3, 10), 2);
    EXPECT_EQ(writer.WriteBytes(source.data(), 5, 5, 1), 0);
    EXPECT_EQ(writer.WriteBytes(source.data(), 5, -1, 1), 0);
    EXPECT_EQ(writer.WriteBytes(source.data(), 5, 0, 5), 2);
    EXPECT_EQ(buffer, (std::array<std::uint8_t, 4>{4, 5, 1, 2}));
    writer.Clear();
    EXPECT_EQ(writer.Idx, 0);
    EXPECT_EQ(buffer, (std::array<std::uint8_t, 4>{}));
}

TEST(ByteArray, ANullBufferOrANegativeSizeHoldsNothing)
{
    std::array<std::uint8_t, 4> buffer{};
    ByteArrayWriter null(nullptr, 10, Endian_Big);
    EXPECT_TRUE(null.writeByte(1));
    null.Clear();
    ByteArrayReader negative(buffer.data(), -1, Endian_Big);
    EXPECT_EQ(negative.readByte(), 0);
    EXPECT_EQ(negative.GetNumberBytesAvailable(), 0);
}

}  // namespace
