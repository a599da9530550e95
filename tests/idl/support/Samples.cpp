#include "Samples.h"

#include "constructs.idl.h"
#include "keys.idl.h"
#include "limits.idl.h"
#include "uav.idl.h"

#include <rabit/idl/MessageType.h>
#include <rabit/idl/MessageTypeRegistry.h>

#include <limits>
#include <ostream>
#include <stdexcept>

namespace
{

template <class T>
constexpr T Lowest = std::numeric_limits<T>::lowest();
template <class T>
constexpr T Highest = std::numeric_limits<T>::max();

template <class Message>
Sample Named(const std::string &name, const Message &message)
{
    return {name, std::make_shared<Message>(message)};
}

Constructs::Numbers NumbersExtreme()
{
    Constructs::Numbers value;
    value.flag = true;
    value.i64 = Lowest<std::int64_t>;
    value.letter = static_cast<char>(-1);
    value.real64 = -1.5e-300;
    value.raw = 255;
    value.i16 = Lowest<std::int16_t>;
    value.i8 = Lowest<std::int8_t>;
    value.u32 = Highest<std::uint32_t>;
    value.u8 = 255;
    value.u64 = Highest<std::uint64_t>;
    value.u16 = 65535;
    value.real32 = std::numeric_limits<float>::infinity();
    value.i32 = Lowest<std::int32_t>;
    return value;
}

Constructs::Numbers NumbersOther()
{
    Constructs::Numbers value;
    value.i64 = Highest<std::int64_t>;
    value.letter = 'x';
    value.real64 = -0.0;
    value.i16 = Highest<std::int16_t>;
    value.i8 = 127;
    value.real32 = std::numeric_limits<float>::denorm_min();
    value.i32 = Highest<std::int32_t>;
    return value;
}

Constructs::Texts TextsFull()
{
    Constructs::Texts value;
    value.free = "gr\xc3\xbc\xc3\x9f dich";
    value.bounded = "four";
    value.label = "eight888";
    value.lines = {"", "two"};
    value.words = {"abc", ""};
    return value;
}

Constructs::Choices ChoicesFull()
{
    using namespace Constructs;
    Choices value;
    value.m = Mode::BUSY;
    value.gap = 9;
    value.tiny = Small::S255;
    value.middle = Medium::M40000;
    value.color = Basics::Color::BLUE;
    value.f8 = Flags8::LOW | Flags8::HIGH;
    value.f16 = Flags16::A16 | Flags16::P16;
    value.f32 = Flags32::A32 | Flags32::B32 | Flags32::Z32;
    value.f64 = Flags64::A64 | Flags64::Z64;
    value.smalls = {Small::S255, Small::S0, Small::S1};
    value.more = {Flags16::A16, Flags16::P16, Flags16{}};
    return value;
}

Constructs::Collections CollectionsFull()
{
    Constructs::Collections value;
    value.bytes = {1, 2, 3, 4, 5};
    value.flags = {true, false};
    value.shorts = {-1, 0, 1};
    value.reals = {2.5};
    value.rows = {{1.0, -1.0}, {}};
    value.points = {{1.0, 2.0}};
    value.few = {{3.0, 4.0}, {5.0, 6.0}};
    value.cells = {{{-1, 2, 0, 0}, {0, 0, 0, 3}, {0, 0, 0, 0}}};
    value.corners = {{{0.5, 0.25}, {-0.5, -0.25}}};
    value.switches = {true, false, true};
    value.code = {'a', 'b', '\0', 'd', 'e'};
    value.deep = {{{}, {7, 8, 9}}};
    value.grids = {{{{1, 2, 3, 4}, {5, 6, 7, 8}, {9, 10, 11, 12}}}};
    value.pair[1] = {2.5};
    return value;
}

Constructs::Collections CollectionsLarge()
{
    Constructs::Collections value;
    value.bytes.assign(3000, 0xaa);
    value.flags.assign(100, true);
    value.reals.assign(200, 1.0 / 3.0);
    value.rows.assign(3, std::vector<double>(9, 7.0));
    value.points.assign(50, {1.0, -1.0});
    value.deep.assign(5, std::vector<std::vector<std::uint8_t>>(5, std::vector<std::uint8_t>(5, 1)));
    value.grids.resize(2);
    return value;
}

Constructs::Number NumberWithText(const std::string &text, std::int32_t discriminator)
{
    Constructs::Number value;
    value.text(text, discriminator);
    return value;
}

Constructs::Unions UnionsFull()
{
    Constructs::Unions value;
    value.val.point({1.0, 2.0}, Basics::Color::BLUE);
    value.num.text("");
    value.optional_grid.present({{{1, 2, 3, 4}, {0, 0, 0, 0}, {0, 0, 0, 0}}});
    value.let.quote("q");
    value.wid.huge(3);
    value.nar.m(Constructs::Mode::GONE);
    value.numbers.resize(3);
    value.numbers[0].real(0.125);
    value.numbers[1] = NumberWithText("five5", 3);
    value.numbers[2].list({1, -1}, 77);
    return value;
}

Constructs::Unions UnionsWithoutMember()
{
    Constructs::Unions value;
    value.optional_grid._default();
    value.let._default();
    value.wid.other(-1, 12345);
    value.nar._default();
    value.num.list({});
    return value;
}

Constructs::Derived DerivedFull()
{
    Constructs::Derived value;
    value.level = 3;
    value.weight = 70.5;
    value.name = "derived";
    value.stamp.node = 4;
    value.stamp.time_ns = 40;
    value.history.resize(2);
    value.history[0].node = 1;
    value.history[0].time_ns = 10;
    value.history[1].node = 2;
    value.history[1].time_ns = 20;
    return value;
}

Limits::Extremes Extremes()
{
    Limits::Extremes value;
    value.high.other(1, 18446744073709551614U);
    value.low.low(5);
    value.quoted.backslash("\\");
    return value;
}

Constructs::Upper UpperFull()
{
    Constructs::Upper value;
    value.id = -7;
    value.kind = 1;
    value.height = 2.0;
    return value;
}

void AddKeys(std::vector<Sample> &samples)
{
    Keys::ShortKey shortKey;
    shortKey.before = "b";
    shortKey.a = 1;
    shortKey.between = {1.0};
    shortKey.b = -2;
    shortKey.c = 3;
    shortKey.after = 4.0;
    samples.push_back(Named("ShortKey", shortKey));
    Keys::ExactKey exactKey;
    exactKey.high = Highest<std::uint64_t>;
    exactKey.low = -2;
    samples.push_back(Named("ExactKey", exactKey));
    Keys::LongKey longKey;
    longKey.first = 1;
    longKey.second = 2;
    longKey.third = 3;
    samples.push_back(Named("LongKey", longKey));
    Keys::TextKey textKey;
    textKey.before = 1;
    textKey.name = "name";
    textKey.after = 2;
    samples.push_back(Named("TextKey", textKey));
    Keys::BoundedTextKey boundedTextKey;
    boundedTextKey.name = "leven bytes";
    boundedTextKey.value = 1.0;
    samples.push_back(Named("BoundedTextKey", boundedTextKey));
    Keys::WideBoundedTextKey wideBoundedTextKey;
    wideBoundedTextKey.name = "x";
    wideBoundedTextKey.value = 1.0;
    samples.push_back(Named("WideBoundedTextKey", wideBoundedTextKey));
    Keys::NestedKey nestedKey;
    nestedKey.place = {7, 0.5, 'z'};
    nestedKey.value = 8;
    nestedKey.plain = {true, 1.5F};
    samples.push_back(Named("NestedKey", nestedKey));
    Keys::ArrayKey arrayKey;
    arrayKey.cells = {{{1, 2, 3}, {4, 5, 6}}};
    arrayKey.kind = Keys::Kind::K1;
    arrayKey.value = 7;
    samples.push_back(Named("ArrayKey", arrayKey));
    Keys::NumberedKey numberedKey;
    numberedKey.first = 3;
    numberedKey.text = "text";
    numberedKey.second = {4, 5};
    samples.push_back(Named("NumberedKey", numberedKey));
    Keys::DerivedKey derivedKey;
    derivedKey.id = 5;
    derivedKey.text = "base";
    derivedKey.more = 0.5;
    samples.push_back(Named("DerivedKey", derivedKey));
}

}  // namespace

std::vector<Sample> AllSamples()
{
    std::vector<Sample> samples{Named("NumbersZero", Constructs::Numbers()),
                                Named("NumbersExtreme", NumbersExtreme()),
                                Named("NumbersOther", NumbersOther()),
                                Named("Defaults", Constructs::Defaults()),
                                Named("TextsEmpty", Constructs::Texts()),
                                Named("TextsFull", TextsFull()),
                                Named("ChoicesDefault", Constructs::Choices()),
                                Named("ChoicesFull", ChoicesFull()),
                                Named("CollectionsEmpty", Constructs::Collections()),
                                Named("CollectionsFull", CollectionsFull()),
                                Named("CollectionsLarge", CollectionsLarge()),
                                Named("UnionsDefault", Constructs::Unions()),
                                Named("UnionsFull", UnionsFull()),
                                Named("UnionsWithoutMember", UnionsWithoutMember()),
                                Named("DerivedDefault", Constructs::Derived()),
                                Named("DerivedFull", DerivedFull()),
                                Named("UpperFull", UpperFull()),
                                Named("InnerEmpty", Constructs::Inner::Empty()),
                                Named("Keywords", Constructs::Keywords()),
                                Named("Global", Global()),
                                Named("ExtremesDefault", Limits::Extremes()),
                                Named("Extremes", Extremes()),
                                Named("UavPose", Uav::Pose()),
                                Named("UavMissionState", Uav::MissionState()),
                                Named("UavGoto", Uav::Goto())};
    AddKeys(samples);
    return samples;
}

std::vector<std::uint8_t> BytesOf(const Rabit::RabitMessage &message)
{
    const Rabit::MessageType *type = Rabit::MessageTypeRegistry::Of(message);
    if (type == nullptr)
    {
        throw std::logic_error("the message has no type");
    }
    std::vector<std::uint8_t> bytes(type->SerializedSize(message));
    bytes.resize(type->Serialize(message, bytes));
    return bytes;
}

void PrintTo(const Sample &sample, std::ostream *out)
{
    *out << sample.Name;
}
