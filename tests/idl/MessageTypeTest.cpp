#include "SampleTest.h"

#include "constructs.idl.h"
#include "flat.idl.h"
#include "uav.idl.h"

#include <rabit/idl/MessageType.h>
#include <rabit/idl/MessageTypeRegistry.h>

#include <stdexcept>

namespace
{

TEST_EACH_SAMPLE(MessageType, IsTypeOfItsOwnMessagesAlone)
{
    const Rabit::MessageType *type = Rabit::MessageTypeRegistry::Of(message);
    for (const Sample &other : AllSamples())
    {
        EXPECT_EQ(type->IsTypeOf(*other.Message), other.Message->GetTypeIndex() == typeid(message))
            << other.Name;
    }
}

TEST_EACH_SAMPLE(MessageType, CreateMakesAMessageOfTheType)
{
    const Rabit::MessageType *type = Rabit::MessageTypeRegistry::Of(message);
    EXPECT_TRUE(type->IsTypeOf(*type->Create()));
    EXPECT_TRUE(type->IsTypeOf(*type->CreateShared()));
    EXPECT_EQ(type->CppType(), std::type_index(typeid(message)));
}

TEST_EACH_SAMPLE(MessageType, AnotherTypesMessageThrows)
{
    const Rabit::MessageType *type = Rabit::MessageTypeRegistry::Of(message);
    Basics::Stamp other;
    std::vector<std::uint8_t> buffer(100);
    EXPECT_THROW(type->SerializedSize(other), std::invalid_argument);
    EXPECT_THROW(type->Serialize(other, buffer), std::invalid_argument);
    EXPECT_THROW(type->Deserialize(buffer, other), std::invalid_argument);
}

TEST(MessageType, NameIsTheIdlName)
{
    EXPECT_EQ(Uav::Pose::IdlType().Name(), "Uav::Pose");
    EXPECT_EQ(Constructs::Inner::Empty::IdlType().Name(), "Constructs::Inner::Empty");
    EXPECT_EQ(Global::IdlType().Name(), "Global");
}

TEST(MessageType, IdlTextHoldsTheTypeAndAllThatItUses)
{
    EXPECT_EQ(Global::IdlType().IdlText(),
              "module Constructs {\n"
              "enum Mode {\n"
              "    IDLE,\n"
              "    @value(100) BUSY,\n"
              "    @default_literal GONE\n"
              "};\n"
              "};\n"
              "module Constructs { module Inner {\n"
              "@final\n"
              "struct Empty {\n"
              "    sequence<octet, 1> nothing;\n"
              "};\n"
              "}; };\n"
              "@final\n"
              "struct Global {\n"
              "    Constructs::Mode m;\n"
              "    Constructs::Inner::Empty empty;\n"
              "};\n");
}

// Readers of other makers know neither struct inheritance nor names that begin with `::`.
TEST(MessageType, IdlTextIsFlat)
{
    EXPECT_EQ(Flat::Highest::IdlType().IdlText(),
              "module Flat {\n"
              "@final @nested\n"
              "struct Value {\n"
              "    long number;\n"
              "};\n"
              "};\n"
              "module Flat {\n"
              "enum Following {\n"
              "    FIRST,\n"
              "    SECOND\n"
              "};\n"
              "};\n"
              "module Flat {\n"
              "@final\n"
              "struct Highest {\n"
              "    @key long id;\n"
              "    string<3> text;\n"
              "    Flat::Value val;\n"
              "    Flat::Following kind;\n"
              "    octet list[3];\n"
              "};\n"
              "};\n");
}

TEST(MessageType, IdlTextTellsANameFromOneThatHidesIt)
{
    const std::string &text = Shadow::Both::IdlType().IdlText();
    EXPECT_NE(text.find("    ::Shadow::Point first;\n    long shadow;\n    ::Shadow::Point second;\n"),
              std::string::npos)
        << text;
}

TEST(MessageType, DerivedMessageIsNotOfItsBasesType)
{
    const Constructs::Upper derived;
    EXPECT_FALSE(Constructs::Ground::IdlType().IsTypeOf(derived));
}

TEST(MessageType, KeyOfABaseCounts)
{
    EXPECT_TRUE(Constructs::Upper::IdlType().HasKey());
    EXPECT_FALSE(Constructs::Derived::IdlType().HasKey());
}

}  // namespace
