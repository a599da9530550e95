// Whether the tokens that participants show before they are authenticated are as long as they say.
#include "guard/TokenCheck.h"

#include <gtest/gtest.h>

#include <string_view>

#include "guard/RtpsBytes.h"

namespace
{

using namespace RtpsBytes;
using Rabit::Rtps::IsGenericMessage;
using Rabit::Rtps::IsToken;
using Rabit::Rtps::RtpsReader;

Bytes Octets(std::size_t size)
{
    return Join({U32(static_cast<std::uint32_t>(size)), Bytes((size + 3) / 4 * 4, 1)});
}

Bytes Token(std::uint32_t properties = 1, std::uint32_t binary = 1)
{
    return Join({Text("DDS:Auth:PKI-DH:1.0+Req"), U32(properties), Text("dds.cert.sn"), Text("uav1"),
                 U32(binary), Text("c.id"), Octets(501)});
}

Bytes Generic(const Bytes &tokens)
{
    return Join({{0, 1, 0, 0}, Bytes(96), Text("dds.sec.auth"), tokens});
}

bool Holds(const Bytes &bytes)
{
    RtpsReader reader(bytes, true);
    return IsToken(reader) && reader.Left() == 0;
}

TEST(TokenCheck, ATokenIsANameAndProperties)
{
    EXPECT_TRUE(Holds(Token()));
    EXPECT_TRUE(Holds(Join({Text("DDS:Access"), U32(0), U32(0)})));
}

TEST(TokenCheck, AMessageOfAHandshakeHasTokens)
{
    EXPECT_TRUE(IsGenericMessage(Generic(Join({U32(1), Token()}))));
    EXPECT_TRUE(IsGenericMessage(Generic(Join({U32(2), Token(), Token()}))));
    Bytes unfilled = Generic(Join({U32(1), Token()}));
    unfilled.resize(unfilled.size() - 3);
    EXPECT_TRUE(IsGenericMessage(unfilled));
}

// The vendor reserved memory for four billion of them, which ended the process.
TEST(TokenCheck, CountsOfWhatIsNotThereAreRefused)
{
    EXPECT_FALSE(Holds(Token(0xffffffff)));
    EXPECT_FALSE(Holds(Token(1, 0xffffffff)));
    EXPECT_FALSE(Holds(Token(1, 65)));
    EXPECT_FALSE(IsGenericMessage(Generic(Join({U32(0xffffffff), Token()}))));
    EXPECT_FALSE(IsGenericMessage(Generic(Join({U32(2), Token()}))));
}

TEST(TokenCheck, LengthsBeyondTheEndAreRefused)
{
    EXPECT_FALSE(Holds(U32(0xffffffff)));
    EXPECT_FALSE(Holds(Join({Text("a"), U32(0), U32(1), Text("c.id"), U32(0xfffffff0), Bytes(16)})));
    Bytes cut = Generic(Join({U32(1), Token()}));
    cut.resize(cut.size() - 8);
    EXPECT_FALSE(IsGenericMessage(cut));
    EXPECT_FALSE(IsGenericMessage(Bytes(3)));
    EXPECT_FALSE(IsGenericMessage(Generic({})));
}

// The signed data is a list of parameters, which Cyclone DDS reads beyond its end if padding is missing
// there.
TEST(TokenCheck, SignedDataWithoutPaddingIsRefused)
{
    const auto message = [](const char *name, std::size_t size) {
        return Generic(Join({U32(1), Text("a"), U32(0), U32(1), Text(name), Octets(size)}));
    };
    EXPECT_TRUE(IsGenericMessage(message("c.pdata", 8)));
    for (const std::size_t size : {5u, 6u, 7u})
    {
        EXPECT_FALSE(IsGenericMessage(message("c.pdata", size)));
        EXPECT_TRUE(IsGenericMessage(message("c.id", size)));
    }
}

// Cyclone DDS takes the first for "c.pdata", and Fast DDS for another name.
TEST(TokenCheck, NamesOfBinaryPropertiesEndAtTheirOnlyZero)
{
    const auto isSound = [](const Bytes &name) {
        return IsGenericMessage(Generic(Join({U32(1), Text("a"), U32(0), U32(1), name, Octets(4)})));
    };
    EXPECT_TRUE(isSound(Text("c.pdata")));
    EXPECT_FALSE(isSound(Join({U32(10), {'c', '.', 'p', 'd', 'a', 't', 'a', 0, 'x', 0, 0, 0}})));
    EXPECT_FALSE(isSound(Join({U32(7), {'c', '.', 'p', 'd', 'a', 't', 'a', 0}})));
    EXPECT_FALSE(isSound(U32(0)));
}

TEST(TokenCheck, OtherEncodingsAreRefused)
{
    Bytes message = Generic(Join({U32(1), Token()}));
    message[1] = 3;
    EXPECT_FALSE(IsGenericMessage(message));
}

TEST(TokenCheck, ABinaryPropertyIsFoundByItsName)
{
    const auto found = [](const Bytes &message, std::string_view name)
    {
        const auto value = Rabit::Rtps::BinaryPropertyOf(message, name);
        return Bytes(value.begin(), value.end());
    };
    const Bytes token =
        Join({Text("a"), U32(0), U32(2), Text("c.id"), Octets(5), Text("c.pdata"), Octets(4)});
    const Bytes message = Generic(Join({U32(1), token}));
    EXPECT_EQ(found(message, "c.id"), Bytes(5, 1));
    EXPECT_EQ(found(message, "c.pdata"), Bytes(4, 1));
    EXPECT_EQ(found(message, "c.pdat"), Bytes());
    EXPECT_EQ(found(message, "c.perm"), Bytes());
    EXPECT_EQ(found(Bytes(3), "c.id"), Bytes());
}

}  // namespace
