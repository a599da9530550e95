// Values that C++ can hold and IDL cannot, and bytes that no value encodes to.
#include "Samples.h"

#include "constructs.idl.h"

#include <rabit/idl/MessageType.h>

#include <gtest/gtest.h>

namespace
{

using Bytes = std::vector<std::uint8_t>;

template <class Message>
bool CanWrite(const Message &message)
{
    Bytes buffer(100000);
    return Message::IdlType().Serialize(message, buffer) != 0;
}

template <class Message>
bool CanRead(const Bytes &bytes)
{
    Message message;
    return Message::IdlType().Deserialize(bytes, message);
}

// The bytes with one of them replaced.
Bytes With(Bytes bytes, std::size_t at, std::uint8_t value)
{
    bytes.at(at) = value;
    return bytes;
}

TEST(ImpossibleValues, StringLongerThanItsBoundIsNotWritten)
{
    Constructs::Texts message;
    message.bounded = "12345";
    EXPECT_FALSE(CanWrite(message));
}

TEST(ImpossibleValues, StringWithAZeroByteIsNotWritten)
{
    Constructs::Texts message;
    message.free = std::string("a\0b", 3);
    EXPECT_FALSE(CanWrite(message));
}

TEST(ImpossibleValues, SequenceLongerThanItsBoundIsNotWritten)
{
    Constructs::Collections message;
    message.shorts = {1, 2, 3, 4};
    EXPECT_FALSE(CanWrite(message));
}

TEST(ImpossibleValues, StringInABoundedSequenceIsCheckedToo)
{
    Constructs::Texts message;
    message.words = {"abcd"};
    EXPECT_FALSE(CanWrite(message));
}

TEST(ImpossibleValues, UndeclaredEnumeratorIsNotWritten)
{
    Constructs::Choices message;
    message.m = static_cast<Constructs::Mode>(1);
    EXPECT_FALSE(CanWrite(message));
}

TEST(ImpossibleValues, UndeclaredBitIsNotWritten)
{
    Constructs::Choices message;
    message.f8 = static_cast<Constructs::Flags8>(2);
    EXPECT_FALSE(CanWrite(message));
}

TEST(ImpossibleValues, BooleanOtherThanZeroAndOneIsNotRead)
{
    const Bytes bytes = BytesOf(Constructs::Numbers());
    EXPECT_TRUE(CanRead<Constructs::Numbers>(With(bytes, 4, 1)));
    EXPECT_FALSE(CanRead<Constructs::Numbers>(With(bytes, 4, 2)));
}

TEST(ImpossibleValues, BooleanInASequenceOtherThanZeroAndOneIsNotRead)
{
    Constructs::Collections message;
    message.flags = {true};
    // Behind the header and the empty `bytes`: length 1, then the element.
    EXPECT_TRUE(CanRead<Constructs::Collections>(With(BytesOf(message), 12, 0)));
    EXPECT_FALSE(CanRead<Constructs::Collections>(With(BytesOf(message), 12, 2)));
}

TEST(ImpossibleValues, UndeclaredEnumeratorIsNotRead)
{
    const Bytes bytes = BytesOf(Constructs::Choices());
    EXPECT_TRUE(CanRead<Constructs::Choices>(With(bytes, 4, 100)));
    EXPECT_FALSE(CanRead<Constructs::Choices>(With(bytes, 4, 1)));
}

TEST(ImpossibleValues, UndeclaredBitIsNotRead)
{
    Constructs::Choices message;
    message.f8 = Constructs::Flags8::HIGH;
    Bytes bytes = BytesOf(message);
    // mode 4, gap 1, tiny 1, middle 2, color 4: the mask is at 16.
    ASSERT_EQ(bytes[16], 0x80);
    EXPECT_FALSE(CanRead<Constructs::Choices>(With(bytes, 16, 0x82)));
}

TEST(ImpossibleValues, DiscriminatorWithoutCaseIsReadOnlyIfTheUnionAllowsIt)
{
    Constructs::Unions message;
    Bytes bytes = BytesOf(message);
    EXPECT_FALSE(CanRead<Constructs::Unions>(With(bytes, 4, 3))) << "Basics::Color has no value 3";
}

TEST(ImpossibleValues, StringWithoutTerminatorIsNotRead)
{
    Constructs::Texts message;
    message.free = "abc";
    const Bytes bytes = BytesOf(message);
    ASSERT_EQ(bytes[11], 0);
    EXPECT_FALSE(CanRead<Constructs::Texts>(With(bytes, 11, 'd')));
}

TEST(ImpossibleValues, StringWithAZeroInsideIsNotRead)
{
    Constructs::Texts message;
    message.free = "abc";
    EXPECT_FALSE(CanRead<Constructs::Texts>(With(BytesOf(message), 9, 0)));
}

TEST(ImpossibleValues, StringOfLengthZeroIsNotRead)
{
    Constructs::Texts message;
    EXPECT_FALSE(CanRead<Constructs::Texts>(With(BytesOf(message), 4, 0)));
}

TEST(ImpossibleValues, StringAboveItsBoundIsNotRead)
{
    // sequence<string<3>, 2> is the last member; the string "abc" in it becomes "abcd".
    Constructs::Texts message;
    message.words = {"abc"};
    Bytes bytes = BytesOf(message);
    const std::size_t length = bytes.size() - 8;
    ASSERT_EQ(bytes[length], 4);
    bytes[length] = 5;
    bytes[bytes.size() - 1] = 'd';
    bytes.insert(bytes.end(), {0, 0, 0, 0});
    EXPECT_FALSE(CanRead<Constructs::Texts>(bytes));
}

TEST(ImpossibleValues, SequenceAboveItsBoundIsNotRead)
{
    const Bytes two{0, 1, 0, 2, 2, 0, 0, 0, 1, 2, 0, 0};
    EXPECT_FALSE(CanRead<Constructs::Inner::Empty>(two));
}

}  // namespace
