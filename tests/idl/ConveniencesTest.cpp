// The functions of generated classes beside the data. This file is compiled with the macros that GNU C++
// defines unless standard C++ alone is requested.
#define linux 1
#define unix 1

#include "constructs.idl.h"
#include "conveniences.idl.h"

#include "Samples.h"

#include <rabit/idl/MessageType.h>
#include <rabit/idl/MessageTypeRegistry.h>

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

namespace
{

using namespace Conveniences;

TEST(Conveniences, MembersMayHaveTheNamesOfMacrosOfGnuCompilers)
{
    Names names;
    names.linux = 1;
    names.unix = 2;
    EXPECT_EQ(names.linux + names.unix, 3);
}

TEST(Conveniences, TheComplementOfABitmaskHasTheDeclaredBitsOnly)
{
    EXPECT_EQ(~Lamps::RED, Lamps::GREEN | Lamps::STROBE);
    EXPECT_EQ(~(Lamps::RED | Lamps::GREEN | Lamps::STROBE), Lamps{});
    EXPECT_EQ(~All32::LOWEST, All32::HIGHEST);
}

TEST(Conveniences, ABitmaskHasBitsIfItHasThemAll)
{
    const Lamps lit = Lamps::RED | Lamps::STROBE;
    EXPECT_TRUE(Has(lit, Lamps::RED));
    EXPECT_TRUE(Has(lit, Lamps::RED | Lamps::STROBE));
    EXPECT_FALSE(Has(lit, Lamps::RED | Lamps::GREEN));
    EXPECT_FALSE(Has(lit, Lamps::GREEN));
}

TEST(Conveniences, EnumsAreReadFromText)
{
    for (const Gear gear : {Gear::OFF, Gear::SLOW, Gear::FAST})
    {
        Gear read = Gear::OFF;
        EXPECT_TRUE(FromText(ToString(gear), read));
        EXPECT_EQ(read, gear);
    }
    Gear kept = Gear::SLOW;
    for (const char *text : {"", "slow", "FASTER", "1"})
    {
        EXPECT_FALSE(FromText(text, kept)) << text;
        EXPECT_EQ(kept, Gear::SLOW);
    }
}

TEST(Conveniences, BitmasksAreReadFromText)
{
    for (const Lamps lamps : {Lamps{}, Lamps::RED, Lamps::GREEN | Lamps::STROBE})
    {
        Lamps read = Lamps::RED;
        EXPECT_TRUE(FromText(ToString(lamps), read));
        EXPECT_EQ(read, lamps);
    }
    Lamps kept = Lamps::GREEN;
    for (const char *text : {"", "RED|", "|RED", "RED|BLUE", "RED GREEN"})
    {
        EXPECT_FALSE(FromText(text, kept)) << text;
        EXPECT_EQ(kept, Lamps::GREEN);
    }
}

TEST(Conveniences, BoundsAreConstantsUnlessAMemberHasTheirName)
{
    static_assert(Motor::name_bound == 8);
    static_assert(Motor::history_bound == 5);
    static_assert(Motor::tag_bound == 12);
    static_assert(Tag_bound == 12);
    Motor motor;
    motor.label_bound = 7;
    EXPECT_EQ(motor.label_bound, 7);
}

TEST(Conveniences, SettersOfUnionsMove)
{
    std::vector<std::string> words(1000, "word");
    const std::string *const first = words.data();
    Part part;
    part.words(std::move(words));
    EXPECT_EQ(part.words().data(), first);
    std::string text(1000, 't');
    const char *const letters = text.data();
    part.text(std::move(text));
    EXPECT_EQ(part.text().data(), letters);
    part.text("literal");
    EXPECT_EQ(part.text(), "literal");
}

TEST(Appendable, HasTheBytesOfFinal)
{
    Closed closed;
    closed.first = 1;
    closed.second = 2.5;
    closed.part.words({"a", "bc"});
    Open::Closed open;
    open.first = 1;
    open.second = 2.5;
    open.part.words({"a", "bc"});
    EXPECT_EQ(BytesOf(open), BytesOf(closed));
}

TEST(Appendable, IsPartOfTheTypesText)
{
    EXPECT_NE(Open::Closed::IdlType().IdlText().find("@appendable\n    struct Closed") == std::string::npos &&
                  Open::Closed::IdlType().IdlText().find("@appendable\nstruct Closed") == std::string::npos,
              true)
        << Open::Closed::IdlType().IdlText();
}

// Messages from elsewhere are shown on terminals.
TEST(Conveniences, TextForPeopleHasNothingThatCommandsATerminal)
{
    Constructs::Texts message;
    message.free =
        "\x1b[2J\x7f\xc2\x9b"
        "31m gr\xc3\xbc\xc3\x9f \xff\xe2\x82";
    EXPECT_NE(message.ToString().find(R"(free: "\x1b[2J\x7f\xc2\x9b31m gr)"
                                      "\xc3\xbc\xc3\x9f"
                                      R"( \xff\xe2\x82")"),
              std::string::npos)
        << message.ToString();
    Constructs::Numbers numbers;
    numbers.letter = static_cast<char>(0x9b);
    EXPECT_NE(numbers.ToString().find(R"(letter: '\x9b')"), std::string::npos) << numbers.ToString();
}

}  // namespace
