// Messages of a type without generated code, as messages of Rabit.
#include <rabit/PublishSubscribeMessage.h>
#include <rabit/dynamic/DynamicMessage.h>
#include <rabit/dynamic/DynamicType.h>
#include <rabit/idl/MessageTypeRegistry.h>

#include <gtest/gtest.h>

#include <memory>
#include <stdexcept>
#include <utility>

#include "basics.idl.h"

namespace Rabit
{
namespace
{

constexpr const char *Text = R"(module Late {
@final
struct Report {
    @default(7) long number;
    string words;
};
};
module Late {
@final
struct Other {
    long number;
};
};
)";

std::shared_ptr<const DynamicType> TypeNamed(const char *name)
{
    return DynamicType::Parse(Text, name).Type;
}

TEST(DynamicMessage, StartsWithDefaults)
{
    const DynamicMessage message(TypeNamed("Late::Report"));
    EXPECT_EQ(message.ToJson(), R"({"number":7,"words":""})");
    EXPECT_EQ(message.ToString(), R"(Late::Report {number: 7, words: ""})");
}

TEST(DynamicMessage, KeepsItsRegistrationWhenItIsAssignedAndItsCloneIsUnregistered)
{
    DynamicMessage source(TypeNamed("Late::Report"));
    source.SetGlobalPublishSubscribeMessageRef(std::make_shared<PublishSubscribeMessage>(source.Clone()));
    DynamicMessage target(TypeNamed("Late::Report"));
    const auto global = std::make_shared<PublishSubscribeMessage>(target.Clone());
    target.SetGlobalPublishSubscribeMessageRef(global);
    target = source;
    EXPECT_EQ(target.GetGlobalPublishSubscribeMessageRef(), global);
    target = std::move(source);
    EXPECT_EQ(target.GetGlobalPublishSubscribeMessageRef(), global);
    EXPECT_EQ(target.Clone()->GetGlobalPublishSubscribeMessageRef(), nullptr);
}

TEST(DynamicType, OfRosHasItsHash)
{
    const auto hashOf = [](const std::string &text, const char *name)
    {
        const ParsedType parsed = DynamicType::Parse(text, name);
        return parsed.Type ? parsed.Type->RosTypeHash() : parsed.Reason;
    };
    const std::string time =
        "module builtin_interfaces { module msg {\n"
        "struct Time { long sec; unsigned long nanosec; };\n}; };\n";
    EXPECT_EQ(hashOf("module std_msgs { module msg { struct _String { string data; }; }; };",
                     "std_msgs::msg::String"),
              "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18");
    EXPECT_EQ(hashOf(time + "module std_msgs { module msg {\nstruct Header { builtin_interfaces::msg::Time "
                            "stamp; string frame_id; };\n}; };",
                     "std_msgs::msg::Header"),
              "RIHS01_f49fb3ae2cf070f793645ff749683ac6b06203e41c891e17701b1cb597ce6a01");
    EXPECT_EQ(hashOf(Text, "Late::Report"), "") << "no module msg";
    for (const char *member :
         {"Mode m;", "long grid[2][3];", "sequence<sequence<long> > rows;", "Other o;"})
    {
        EXPECT_EQ(hashOf("module Late { struct Other { long x; }; };\nmodule p { module msg {\n"
                         "enum Mode { ON, OFF };\ntypedef Late::Other Other;\nstruct S { " +
                             std::string(member) + " };\n}; };",
                         "p::msg::S"),
                  "")
            << member;
    }
}

TEST(DynamicType, TellsTheSizeThatAllItsSamplesHave)
{
    const auto sizeOf = [](const char *members)
    {
        return DynamicType::Parse(
                   "module M {\nunion U switch (long) { case 1: long a; };\n"
                   "struct Part { octet o; double d; };\nstruct T { " +
                       std::string(members) + " };\n};\n",
                   "M::T")
            .Type->FixedSize();
    };
    EXPECT_EQ(sizeOf("octet a; long b;"), 8u);
    EXPECT_EQ(sizeOf("Part parts[2]; octet last;"), 36u) << "filled up to a multiple of four";
    EXPECT_EQ(sizeOf("long a; string b;"), std::nullopt);
    EXPECT_EQ(sizeOf("sequence<octet> a;"), std::nullopt);
    EXPECT_EQ(sizeOf("U a;"), std::nullopt);
}

TEST(DynamicMessage, TakesOverJsonOrTellsWhyNot)
{
    DynamicMessage message(TypeNamed("Late::Report"));
    EXPECT_EQ(message.SetJson(R"({"words": "over"})"), "");
    EXPECT_EQ(message.ToJson(), R"({"number":7,"words":"over"})");
    EXPECT_EQ(message.SetJson(R"({"word": "out"})"),
              "no member of Late::Report is named `word`; did you mean `words`?");
    EXPECT_EQ(message.ToJson(), R"({"number":7,"words":"over"})") << "unchanged";
}

TEST(DynamicMessage, IsClearedToItsDefaults)
{
    DynamicMessage message(TypeNamed("Late::Report"));
    ASSERT_EQ(message.SetJson(R"({"number": 1})"), "");
    message.Clear();
    EXPECT_EQ(message.ToJson(), R"({"number":7,"words":""})");
}

TEST(DynamicMessage, IsCopiedOnlyToItsOwnType)
{
    DynamicMessage from(TypeNamed("Late::Report"));
    ASSERT_EQ(from.SetJson(R"({"number": 1})"), "");
    DynamicMessage same(TypeNamed("Late::Report"));
    EXPECT_TRUE(same.CopyMessage(&from)) << "another object of the same text";
    EXPECT_EQ(same.ToJson(), from.ToJson());
    DynamicMessage other(TypeNamed("Late::Other"));
    EXPECT_FALSE(other.CopyMessage(&from));
    Basics::Stamp stamp;
    EXPECT_FALSE(same.CopyMessage(&stamp));
    EXPECT_EQ(same.Clone()->ToString(), from.ToString());
}

TEST(DynamicMessage, BytesThatAreNoSampleChangeNothing)
{
    DynamicMessage message(TypeNamed("Late::Report"));
    ASSERT_EQ(message.SetJson(R"({"number": 1})"), "");
    const std::vector<std::uint8_t> before = message.Sample();
    EXPECT_FALSE(message.SetSample(std::vector<std::uint8_t>{0, 1, 0, 0, 1}));
    EXPECT_EQ(message.Sample(), before);
}

TEST(DynamicMessage, TypesRefuseMessagesOfOthers)
{
    const auto type = TypeNamed("Late::Report");
    DynamicMessage other(TypeNamed("Late::Other"));
    Basics::Stamp stamp;
    EXPECT_THROW(type->SerializedSize(other), std::invalid_argument);
    EXPECT_THROW(type->Deserialize(type->DefaultSample(), stamp), std::invalid_argument);
}

TEST(DynamicMessage, WithoutATypeIsAProgrammingError)
{
    EXPECT_THROW(DynamicMessage(nullptr), std::invalid_argument);
}

TEST(DynamicMessage, TellsTheRegistryItsType)
{
    const auto report = TypeNamed("Late::Report");
    const auto other = TypeNamed("Late::Other");
    EXPECT_EQ(DynamicType::Register(report), report.get());
    EXPECT_EQ(DynamicType::Register(other), other.get());
    EXPECT_EQ(MessageTypeRegistry::Find("Late::Other"), other.get());
    // All such messages have one C++ class.
    EXPECT_EQ(MessageTypeRegistry::Of(*report->Create()), report.get());
    EXPECT_EQ(MessageTypeRegistry::Of(*other->Create()), other.get());
}

TEST(DynamicMessage, RegisteredTwiceIsTheFirstOne)
{
    const auto first = DynamicType::Register(TypeNamed("Late::Report"));
    EXPECT_EQ(DynamicType::Register(TypeNamed("Late::Report")), first);
}

TEST(DynamicMessage, AGeneratedTypeOfTheSameTextStays)
{
    const MessageType &generated = Basics::Stamp::IdlType();
    const auto dynamic = DynamicType::Parse(generated.IdlText(), generated.Name()).Type;
    EXPECT_EQ(DynamicType::Register(dynamic), &generated);
}

TEST(DynamicMessage, AnotherDefinitionOfARegisteredNameIsRefused)
{
    const auto other =
        DynamicType::Parse("module Basics { struct Stamp { long number; }; };", "Basics::Stamp");
    ASSERT_TRUE(other.Type) << other.Reason;
    EXPECT_EQ(DynamicType::Register(other.Type), nullptr);
}

}  // namespace
}  // namespace Rabit
