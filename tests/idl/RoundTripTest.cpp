#include "SampleTest.h"

#include <rabit/idl/MessageType.h>
#include <rabit/idl/MessageTypeRegistry.h>

#include "constructs.idl.h"

#include <cmath>
#include <cstring>
#include <limits>

namespace
{

TEST_EACH_SAMPLE(RoundTrip, DecodedMessageEncodesToTheSameBytes)
{
    const Rabit::MessageType *type = Rabit::MessageTypeRegistry::Of(message);
    const std::vector<std::uint8_t> bytes = BytesOf(message);
    const auto decoded = type->Create();
    ASSERT_TRUE(type->Deserialize(bytes, *decoded));
    EXPECT_EQ(BytesOf(*decoded), bytes);
}

TEST_EACH_SAMPLE(RoundTrip, DecodedMessageReadsTheSame)
{
    const Rabit::MessageType *type = Rabit::MessageTypeRegistry::Of(message);
    const auto decoded = type->Create();
    ASSERT_TRUE(type->Deserialize(BytesOf(message), *decoded));
    EXPECT_EQ(decoded->ToString(), message.ToString());
}

TEST_EACH_SAMPLE(RoundTrip, OldContentsOfTheTargetDoNotShowThrough)
{
    const Rabit::MessageType *type = Rabit::MessageTypeRegistry::Of(message);
    for (const Sample &other : AllSamples())
    {
        if (type->IsTypeOf(*other.Message))
        {
            const auto target = other.Message->Clone();
            ASSERT_TRUE(type->Deserialize(BytesOf(message), *target));
            EXPECT_EQ(BytesOf(*target), BytesOf(message)) << "over " << other.Name;
        }
    }
}

TEST_EACH_SAMPLE(RoundTrip, SizeIsExactlyWhatIsWrittenAndAMultipleOfFour)
{
    const Rabit::MessageType *type = Rabit::MessageTypeRegistry::Of(message);
    std::vector<std::uint8_t> buffer(type->SerializedSize(message) + 64, 0xee);
    const std::size_t written = type->Serialize(message, buffer);
    EXPECT_EQ(written, type->SerializedSize(message));
    EXPECT_EQ(written % 4, 0U);
    EXPECT_EQ(buffer[written], 0xee);
}

TEST_EACH_SAMPLE(RoundTrip, EveryByteIsWrittenWhateverTheBufferHeld)
{
    const Rabit::MessageType *type = Rabit::MessageTypeRegistry::Of(message);
    std::vector<std::uint8_t> zeros(type->SerializedSize(message), 0x00);
    std::vector<std::uint8_t> ones(type->SerializedSize(message), 0xff);
    type->Serialize(message, zeros);
    type->Serialize(message, ones);
    EXPECT_EQ(zeros, ones);
}

TEST_EACH_SAMPLE(RoundTrip, BufferOneByteTooSmallIsRefused)
{
    const Rabit::MessageType *type = Rabit::MessageTypeRegistry::Of(message);
    const std::size_t size = type->SerializedSize(message);
    for (std::size_t less = 1; less <= size && less <= 64; ++less)
    {
        std::vector<std::uint8_t> buffer(size - less);
        EXPECT_EQ(type->Serialize(message, buffer), 0U) << less << " bytes too small";
    }
}

TEST_EACH_SAMPLE(RoundTrip, RabitSerializeGivesTheSameBytes)
{
    const auto copy = message.Clone();
    const std::vector<std::uint8_t> bytes = BytesOf(message);
    std::vector<std::uint8_t> buffer(bytes.size());
    EXPECT_EQ(copy->Serialize(buffer.data(), static_cast<int>(buffer.size())),
              static_cast<int>(bytes.size()));
    EXPECT_EQ(buffer, bytes);
}

TEST_EACH_SAMPLE(RoundTrip, RabitDeSerializeReadsThem)
{
    std::vector<std::uint8_t> bytes = BytesOf(message);
    const auto target = Rabit::MessageTypeRegistry::Of(message)->Create();
    EXPECT_EQ(target->DeSerialize(bytes.data(), static_cast<int>(bytes.size())),
              static_cast<int>(bytes.size()));
    EXPECT_EQ(target->ToString(), message.ToString());
}

template <class T>
std::uint64_t BitsOf(T value)
{
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof value);
    return bits;
}

TEST(RoundTrip, KeepsTheBitsOfNaN)
{
    Constructs::Numbers message;
    message.real64 = -std::numeric_limits<double>::quiet_NaN();
    message.real32 = std::nanf("0x1234");
    Constructs::Numbers decoded;
    ASSERT_TRUE(Constructs::Numbers::IdlType().Deserialize(BytesOf(message), decoded));
    EXPECT_EQ(BitsOf(decoded.real64), BitsOf(message.real64));
    EXPECT_EQ(BitsOf(decoded.real32), BitsOf(message.real32));
}

TEST(RoundTrip, ValuesArriveInTheirMembers)
{
    Constructs::Derived message;
    message.level = 9;
    message.weight = 1.25;
    message.name = "n\n\"";
    message.stamp.time_ns = 77;
    message.history.resize(3);
    message.history[2].node = 5;
    Constructs::Derived decoded;
    ASSERT_TRUE(Constructs::Derived::IdlType().Deserialize(BytesOf(message), decoded));
    EXPECT_EQ(decoded, message);
    EXPECT_EQ(decoded.level, 9);
    EXPECT_EQ(decoded.weight, 1.25);
    EXPECT_EQ(decoded.name, "n\n\"");
    EXPECT_EQ(decoded.history[2].node, 5);
}

TEST(RoundTrip, DeserializeKeepsTimeStampAndInts)
{
    Constructs::Derived source;
    source.SetTimeStamp(1.0);
    source.MessageType = 1;
    Constructs::Derived target;
    target.SetTimeStamp(2.0);
    target.MessageType = 2;
    target.MessageSource = 3;
    target.MessageDestination = 4;
    ASSERT_TRUE(Constructs::Derived::IdlType().Deserialize(BytesOf(source), target));
    EXPECT_EQ(target.GetTimeStamp(), 2.0);
    EXPECT_EQ(target.MessageType, 2);
    EXPECT_EQ(target.MessageSource, 3);
    EXPECT_EQ(target.MessageDestination, 4);
}

}  // namespace
