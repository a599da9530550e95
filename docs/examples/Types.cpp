// Message types at run time: bytes, JSON, and types that a program was not built with.
#include <gtest/gtest.h>
#include <rabit/dynamic/CdrBuilder.h>
#include <rabit/dynamic/DynamicMessage.h>
#include <rabit/dynamic/DynamicType.h>
#include <rabit/dynamic/IdlFile.h>
#include <rabit/dynamic/Shape.h>
#include <rabit/idl/Box.h>
#include <rabit/idl/CdrReader.h>
#include <rabit/idl/CdrSizer.h>
#include <rabit/idl/CdrWriter.h>
#include <rabit/idl/Codec.h>
#include <rabit/idl/FastCdr.h>
#include <rabit/idl/Fresh.h>
#include <rabit/idl/GeneratedMessageType.h>
#include <rabit/idl/KeyHasher.h>
#include <rabit/idl/MessageType.h>
#include <rabit/idl/MessageTypeRegistry.h>
#include <rabit/idl/NearestWord.h>
#include <rabit/idl/SelfDescribing.h>
#include <rabit/idl/Shapes.h>
#include <rabit/idl/TextWriter.h>
#include <rabit/idl/Utf8.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "uav.idl.h"

namespace
{

// [bytes]
TEST(TypesExample, AMessageBecomesBytesAndAMessageAgain)
{
    const Rabit::MessageType *type = Rabit::MessageTypeRegistry::Find("Uav::GoHome");
    ASSERT_NE(type, nullptr);
    Uav::GoHome home;
    home.reason = "battery";
    std::vector<std::uint8_t> bytes(type->SerializedSize(home));
    EXPECT_EQ(type->Serialize(home, bytes), bytes.size());

    const std::unique_ptr<Rabit::RabitMessage> read = type->Create();
    EXPECT_TRUE(type->Deserialize(bytes, *read));
    EXPECT_EQ(static_cast<Uav::GoHome &>(*read).reason, "battery");
}
// [/bytes]

// [dynamic]
TEST(TypesExample, ATypeMayBeKnownAtRunTimeAlone)
{
    const Rabit::ParsedType parsed = Rabit::DynamicType::Parse(
        "module Late { @final struct Report { long number; string text; }; };", "Late::Report");
    ASSERT_TRUE(parsed.Type) << parsed.Reason;

    Rabit::DynamicMessage message(parsed.Type);
    EXPECT_EQ(message.SetJson(R"({"number": 3, "text": "hello"})"), "");
    EXPECT_EQ(message.ToJson(), R"({"number":3,"text":"hello"})");
    EXPECT_EQ(parsed.Type->FromJson(R"({"nummer": 3})").Reason.find("no member"), 0u);

    // Messages of all such types have one class, so the message itself tells its type.
    const Rabit::Idl::SelfDescribing &describing = message;
    EXPECT_EQ(describing.IdlType().Name(), "Late::Report");
}
// [/dynamic]

// [file]
TEST(TypesExample, AnIdlFileIsLoadedWhileTheProgramRuns)
{
    const std::filesystem::path path = std::filesystem::temp_directory_path() / "rabit_types_example.idl";
    std::ofstream(path)
        << "module Loaded {\nconst long Most = 4;\n// A point.\n@final struct Point { double x; };\n};\n";
    const Rabit::IdlFile file = Rabit::IdlFile::Load(path.string());
    std::filesystem::remove(path);
    ASSERT_EQ(file.Reason, "");
    const std::shared_ptr<const Rabit::DynamicType> point = file.Messages.at(0);
    EXPECT_EQ(point->Name(), "Loaded::Point");
    EXPECT_EQ(file.Comments.at("Loaded::Point"), "A point.");

    // The shape tells the members; a builder makes samples of them.
    EXPECT_EQ(point->Root().Parts.at(0).Name, "x");
    EXPECT_EQ(point->Root().Parts.at(0).Type->What, Rabit::Dynamic::Kind::Double);
    Rabit::Dynamic::CdrBuilder builder;
    builder.Put(0, 8);
    EXPECT_EQ(builder.Finish(), point->DefaultSample());
}
// [/file]

// [cdr]
TEST(TypesExample, CdrIsWrittenAndReadByHand)
{
    Rabit::Idl::CdrSizer sizer;
    sizer.Add(1);
    sizer.Add(8);
    std::vector<std::uint8_t> bytes(sizer.Used());
    Rabit::Idl::CdrWriter writer(bytes);
    EXPECT_TRUE(writer.Put(std::uint8_t{7}));
    EXPECT_TRUE(writer.Put(2.5));  // aligned to eight bytes

    Rabit::Idl::CdrReader reader(bytes, true);
    std::uint8_t number = 0;
    double value = 0;
    EXPECT_TRUE(reader.Get(number) && reader.Get(value));
    EXPECT_EQ(value, 2.5);
    EXPECT_FALSE(reader.Get(number));  // there is no more
}
// [/cdr]

// [generated]
// What the code that idlc generates is made of.
TEST(TypesExample, GeneratedCodeUsesTheseParts)
{
    Rabit::Idl::KeyHasher key(true);
    key.Put(std::uint32_t{1});
    EXPECT_EQ(key.Finish()[3], 1);  // big endian

    Rabit::Idl::TextWriter text;
    text.Put(std::string_view("uav1"));
    EXPECT_EQ(text.Text(), "\"uav1\"");

    Rabit::Idl::Box<std::string> large;  // a large member of a union
    large.Get() = "on the heap";
    EXPECT_EQ(Rabit::Idl::Box<std::string>(large), large);

    using Made = Rabit::Idl::GeneratedMessageType<Uav::Pose>;  // one object for each message class
    EXPECT_NE(dynamic_cast<const Made *>(Rabit::MessageTypeRegistry::Find("Uav::Pose")), nullptr);

    EXPECT_EQ(Rabit::Idl::FreshValue<int>::Make(), 0);
    static_assert(Rabit::Idl::Scalar<double>::MinSize == 8);
    static_assert(Rabit::Idl::Codec<Uav::Pose>::FixedSize > 0);

    std::array<char, 8> memory{};
    eprosima::fastcdr::FastBuffer buffer(memory.data(), memory.size());
    Rabit::Idl::FastCdr cdr(buffer, Rabit::Idl::FastCdr::LITTLE_ENDIANNESS);  // whichever Fast-CDR there is
    cdr.serialize(std::uint32_t{5});
    EXPECT_EQ(cdr.Used(), 4u);
}
// [/generated]

// [words]
TEST(TypesExample, AWrongWordIsAnsweredWithTheNearest)
{
    EXPECT_EQ(Rabit::NearestWordHint("Poze", {"Pose", "Health"}), "; did you mean `Pose`?");
    EXPECT_EQ(Rabit::Idl::Utf8CharacterSize("\xc3\xbc", 0), 2u);
}
// [/words]

}  // namespace
