// A message that was just made, cleared or grown can be sent: every enum in it has a valid value.
#include "Samples.h"

#include "fresh.idl.h"

#include <rabit/idl/MessageType.h>
#include <rabit/idl/MessageTypeRegistry.h>

#include <gtest/gtest.h>

#include <type_traits>

namespace
{

Fresh::All Grown()
{
    Fresh::All message;
    message.list.resize(3);
    message.middles.resize(2);
    message.pairs.resize(2);
    message.rows.resize(2);
    message.rows[1].resize(2);
    message.lists[1].resize(4);
    message.smalls.resize(2);
    message.larges.resize(2);
    return message;
}

TEST(Fresh, AMessageCanBeSent)
{
    EXPECT_FALSE(BytesOf(Fresh::All()).empty());
}

TEST(Fresh, AClearedMessageCanBeSentAndIsANewOne)
{
    Fresh::All message = Grown();
    message.grid[1][2] = Fresh::Zeroless::FIVE;
    message.small.many({});
    message.Clear();
    EXPECT_EQ(message, Fresh::All());
    EXPECT_FALSE(BytesOf(message).empty());
}

TEST(Fresh, ElementsThatWereAddedByResizingCanBeSent)
{
    const Fresh::All message = Grown();
    EXPECT_EQ(message.list[2], Fresh::Zeroless::THREE);
    EXPECT_EQ(message.middles[0], Fresh::Middle::SECOND);
    EXPECT_EQ(message.pairs[1][1], Fresh::Zeroless::THREE);
    EXPECT_EQ(message.rows[1][0], Fresh::Zeroless::THREE);
    EXPECT_FALSE(BytesOf(message).empty());
}

TEST(Fresh, AUnionsFirstMemberStartsWithItsDefault)
{
    EXPECT_EQ(Fresh::FirstSmall().one(), Fresh::Zeroless::THREE);
    EXPECT_EQ(Fresh::FirstLarge().many()[19], Fresh::Zeroless::THREE);
    Fresh::FirstLarge written;
    written.many()[0] = Fresh::Zeroless::FIVE;
    EXPECT_EQ(written.many()[19], Fresh::Zeroless::THREE);
}

TEST(Fresh, SurvivesTheRoundTrip)
{
    const Fresh::All message = Grown();
    Fresh::All read;
    ASSERT_TRUE(Fresh::All::IdlType().Deserialize(BytesOf(message), read));
    EXPECT_EQ(read, message);
}

TEST(Fresh, SequencesOfEnumsThatStartAtZeroStayPlainVectors)
{
    static_assert(std::is_same_v<decltype(Fresh::All::usuals), std::vector<Fresh::Usual>>);
    EXPECT_TRUE(Fresh::All().usuals.empty());
}

}  // namespace
