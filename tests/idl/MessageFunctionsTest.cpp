#include "SampleTest.h"

#include "constructs.idl.h"
#include "limits.idl.h"

#include <rabit/PublishSubscribeMessage.h>

#include <limits>
#include <utility>

namespace
{

TEST_EACH_SAMPLE(MessageFunctions, CloneIsOfTheSameTypeWithTheSameContents)
{
    const auto clone = message.Clone();
    EXPECT_EQ(clone->GetTypeIndex(), std::type_index(typeid(message)));
    EXPECT_EQ(BytesOf(*clone), BytesOf(message));
    EXPECT_EQ(clone->GetTimeStamp(), message.GetTimeStamp());
}

TEST_EACH_SAMPLE(MessageFunctions, CopyMessageTakesContentsStampAndInts)
{
    const auto source = message.Clone();
    source->SetTimeStamp(123.5);
    source->MessageSource = 6;
    const auto target = message.Clone();
    target->Clear();
    ASSERT_TRUE(target->CopyMessage(source.get()));
    EXPECT_EQ(BytesOf(*target), BytesOf(*source));
    EXPECT_EQ(target->GetTimeStamp(), 123.5);
    EXPECT_EQ(target->MessageSource, 6);
}

TEST_EACH_SAMPLE(MessageFunctions, CopyMessageRefusesEveryOtherType)
{
    const auto target = message.Clone();
    EXPECT_FALSE(target->CopyMessage(nullptr));
    for (const Sample &other : AllSamples())
    {
        if (other.Message->GetTypeIndex() != typeid(message))
        {
            EXPECT_FALSE(target->CopyMessage(other.Message.get())) << other.Name;
        }
    }
    EXPECT_EQ(BytesOf(*target), BytesOf(message));
}

TEST_EACH_SAMPLE(MessageFunctions, ClearGivesTheDefaults)
{
    const auto cleared = message.Clone();
    cleared->Clear();
    for (const Sample &other : AllSamples())
    {
        const bool isDefault = other.Name.ends_with("Zero") || other.Name.ends_with("Empty") ||
                               other.Name.ends_with("Default") || other.Name.ends_with("Defaults");
        if (isDefault && other.Message->GetTypeIndex() == typeid(message))
        {
            EXPECT_EQ(BytesOf(*cleared), BytesOf(*other.Message));
        }
    }
    EXPECT_EQ(cleared->GetTimeStamp(), 0.0);
}

TEST_EACH_SAMPLE(MessageFunctions, TextBeginsWithTheIdlName)
{
    const std::string text = message.ToString();
    EXPECT_NE(text.find(" {"), std::string::npos) << text;
    EXPECT_EQ(text.back(), '}') << text;
}

TEST(MessageFunctions, CopyMessageKeepsTheGlobalReference)
{
    Constructs::Numbers source;
    Constructs::Numbers target;
    const auto global = std::make_shared<Rabit::PublishSubscribeMessage>(target.Clone());
    target.SetGlobalPublishSubscribeMessageRef(global);
    ASSERT_TRUE(target.CopyMessage(&source));
    EXPECT_EQ(target.GetGlobalPublishSubscribeMessageRef(), global);
}

TEST(MessageFunctions, AssignmentKeepsTheGlobalReference)
{
    Constructs::Numbers source;
    Constructs::Numbers target;
    source.SetGlobalPublishSubscribeMessageRef(
        std::make_shared<Rabit::PublishSubscribeMessage>(source.Clone()));
    const auto global = std::make_shared<Rabit::PublishSubscribeMessage>(target.Clone());
    target.SetGlobalPublishSubscribeMessageRef(global);
    target = source;
    EXPECT_EQ(target.GetGlobalPublishSubscribeMessageRef(), global);
    target = std::move(source);
    EXPECT_EQ(target.GetGlobalPublishSubscribeMessageRef(), global);
}

TEST(MessageFunctions, ACloneIsUnregistered)
{
    Constructs::Numbers source;
    source.SetGlobalPublishSubscribeMessageRef(
        std::make_shared<Rabit::PublishSubscribeMessage>(source.Clone()));
    EXPECT_EQ(source.Clone()->GetGlobalPublishSubscribeMessageRef(), nullptr);
}

TEST(MessageFunctions, DefaultsAreThoseOfTheIdl)
{
    const Constructs::Defaults message;
    EXPECT_TRUE(message.flag);
    EXPECT_EQ(message.letter, 'x');
    EXPECT_EQ(message.raw, 200);
    EXPECT_EQ(message.i8, -5);
    EXPECT_EQ(message.i16, -300);
    EXPECT_EQ(message.u32, 4000000000U);
    EXPECT_EQ(message.i64, 9000000000);
    EXPECT_EQ(message.u64, 18446744073709551615U);
    EXPECT_EQ(message.real32, 0.25F);
    EXPECT_EQ(message.real64, -1.5);
    EXPECT_EQ(message.text, "none \"yet\"");
    EXPECT_EQ(message.bounded, "abc");
}

TEST(MessageFunctions, DefaultsMayContainQuotesAndControlCharacters)
{
    const Limits::Extremes message;
    EXPECT_EQ(message.quote, '\'');
    EXPECT_EQ(message.backslash, '\\');
    EXPECT_EQ(message.text, "'\\\"\x01?\x7f");
}

TEST(MessageFunctions, ClearRestoresTheDefaultsOfTheIdl)
{
    Constructs::Defaults message;
    message.flag = false;
    message.text = "changed";
    message.real64 = 3.0;
    message.Clear();
    EXPECT_EQ(message, Constructs::Defaults());
}

TEST(MessageFunctions, EnumStartsWithItsDefaultLiteral)
{
    EXPECT_EQ(Constructs::Choices().m, Constructs::Mode::GONE);
    EXPECT_EQ(Constructs::Choices().tiny, Constructs::Small::S0);
}

TEST(MessageFunctions, ConstantsHaveTheirValues)
{
    EXPECT_EQ(Constructs::C_SHORT, -3);
    EXPECT_EQ(Constructs::C_USHORT, 65535);
    EXPECT_EQ(Constructs::C_LONG, std::numeric_limits<std::int32_t>::min());
    EXPECT_EQ(Constructs::C_ULONG, 4000000000U);
    EXPECT_EQ(Constructs::C_LLONG, -9223372036854775807LL);
    EXPECT_EQ(Constructs::C_ULLONG, 18446744073709551615U);
    EXPECT_EQ(Constructs::C_FLOAT, 0.1F);
    EXPECT_EQ(Constructs::C_DOUBLE, 1.0e300);
    EXPECT_TRUE(Constructs::C_BOOLEAN);
    EXPECT_EQ(Constructs::C_CHAR, 'c');
    EXPECT_EQ(Limits::QUOTE, '\'');
    EXPECT_EQ(Constructs::C_OCTET, 255);
    EXPECT_EQ(Constructs::C_STRING, "a \"b\" \\ ?? \x01");
    EXPECT_EQ(Constructs::C_COLOR, Basics::Color::BLUE);
}

TEST(MessageFunctions, EqualityLooksAtEveryMemberAndNotAtTheStamp)
{
    Constructs::Numbers a;
    Constructs::Numbers b;
    b.SetTimeStamp(a.GetTimeStamp() + 1.0);
    b.MessageType = 9;
    EXPECT_EQ(a, b);
    b.i32 = 1;
    EXPECT_NE(a, b);
}

TEST(MessageFunctions, EqualityLooksAtMembersOfBases)
{
    Constructs::Derived a;
    Constructs::Derived b;
    b.level = 1;
    EXPECT_NE(a, b);
}

TEST(MessageFunctions, NaNIsUnlikeItselfAndMinusZeroEqualsZero)
{
    Constructs::Numbers a;
    a.real64 = -0.0;
    EXPECT_EQ(a, Constructs::Numbers());
    a.real64 = std::numeric_limits<double>::quiet_NaN();
    const Constructs::Numbers b = a;
    EXPECT_NE(a, b);
}

TEST(MessageFunctions, TextShowsNamesAndValues)
{
    Constructs::Texts message;
    message.free = "a\"\n";
    message.words = {"x", "y"};
    EXPECT_EQ(message.ToString(),
              "Constructs::Texts {free: \"a\\\"\\x0a\", bounded: \"\", label: \"\", lines: [\"\", \"\"], "
              "words: [\"x\", \"y\"]}");
}

TEST(MessageFunctions, TextShowsEnumsAndBitmasksByName)
{
    EXPECT_EQ(ToString(Constructs::Mode::BUSY), "BUSY");
    EXPECT_EQ(ToString(static_cast<Constructs::Mode>(5)), "5");
    EXPECT_EQ(ToString(Constructs::Flags8::LOW | Constructs::Flags8::HIGH), "LOW|HIGH");
    EXPECT_EQ(ToString(Constructs::Flags8{}), "0");
    EXPECT_EQ(ToString(static_cast<Constructs::Flags8>(3)), "LOW|2");
}

TEST(MessageFunctions, TextOfALongSequenceIsCutShort)
{
    Constructs::Collections message;
    message.bytes.assign(1000, 1);
    EXPECT_NE(message.ToString().find("1, 1, ... 984 more]"), std::string::npos) << message.ToString();
}

TEST(MessageFunctions, NestedStructHasNoMessageAroundIt)
{
    static_assert(!std::is_base_of_v<Rabit::RabitMessage, Basics::Point>);
    static_assert(sizeof(Basics::Point) == 2 * sizeof(double));
    EXPECT_EQ(ToString(Basics::Point{1.0, 2.5}), "{x: 1, y: 2.5}");
}

TEST(MessageFunctions, SerializeRefusesBadArguments)
{
    Constructs::Numbers message;
    std::uint8_t buffer[256];
    EXPECT_EQ(message.Serialize(nullptr, 256), 0);
    EXPECT_EQ(message.Serialize(buffer, 0), 0);
    EXPECT_EQ(message.Serialize(buffer, -1), 0);
    EXPECT_EQ(message.Serialize(buffer, 256, 1), 0) << "only one encoding is known";
    EXPECT_EQ(message.DeSerialize(nullptr, 256), 0);
    EXPECT_EQ(message.DeSerialize(buffer, -1), 0);
}

}  // namespace
