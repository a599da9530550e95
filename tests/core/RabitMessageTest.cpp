#include "TestMessages.h"

#include <rabit/PublishSubscribeMessage.h>
#include <rabit/RabitMessage.h>
#include <rabit/RabitWorkspace.h>

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

namespace
{

using namespace Rabit;
using namespace RabitTest;

TEST(RabitMessage, IsMadeWithTheCurrentTimeAndZeroedFields)
{
    const double before = SystemTimeClock::GetSystemTimeClock()->GetCurrentGpsTimeInSeconds();
    const NumberMessage message;
    const double after = SystemTimeClock::GetSystemTimeClock()->GetCurrentGpsTimeInSeconds();
    EXPECT_EQ(message.MessageType, 0);
    EXPECT_EQ(message.MessageSource, 0);
    EXPECT_EQ(message.MessageDestination, 0);
    EXPECT_LE(before, message.GetTimeStamp());
    EXPECT_GE(after, message.GetTimeStamp());
}

TEST(RabitMessage, TheBaseCopyTakesTheStampAndTheThreeIntsButNotTheReference)
{
    NumberMessage from;
    from.MessageType = 1;
    from.MessageSource = 2;
    from.MessageDestination = 3;
    from.SetTimeStamp(4.0);
    from.SetGlobalPublishSubscribeMessageRef(std::make_shared<PublishSubscribeMessage>(from.Clone()));
    NumberMessage to;
    EXPECT_TRUE(to.CopyMessage(&from));
    EXPECT_EQ(to.MessageType, 1);
    EXPECT_EQ(to.MessageSource, 2);
    EXPECT_EQ(to.MessageDestination, 3);
    EXPECT_EQ(to.GetTimeStamp(), 4.0);
    EXPECT_EQ(to.GetGlobalPublishSubscribeMessageRef(), nullptr);
}

// Returns a message whose contents may be assigned, registered under this name.
std::shared_ptr<NumberMessage> Registered(RabitWorkspace &workspace, const std::string &name, int number)
{
    auto message = std::make_shared<NumberMessage>();
    message->Number = number;
    workspace.AddPublishSubscribeMessage(name, message);
    return message;
}

TEST(RabitMessage, AssignmentTakesTheContentsAndLeavesTheRegistration)
{
    RabitWorkspace workspace;
    const auto mine = Registered(workspace, "Mine", 1);
    const auto theirs = Registered(workspace, "Theirs", 2);
    theirs->MessageType = 3;
    theirs->PostMessage();
    *mine = *theirs;
    EXPECT_EQ(mine->Number, 2);
    EXPECT_EQ(mine->MessageType, 3);
    EXPECT_EQ(mine->GetTimeStamp(), theirs->GetTimeStamp());
    EXPECT_TRUE(mine->WasPosted());
    EXPECT_EQ(mine->GetGlobalPublishSubscribeMessageRef(), workspace.FindGlobalMessage("Mine"));
}

TEST(RabitMessage, PostsToItsOwnNameAfterAnAssignment)
{
    RabitWorkspace workspace;
    const auto mine = Registered(workspace, "Mine", 1);
    const auto theirs = Registered(workspace, "Theirs", 2);
    *mine = *theirs;
    mine->PostMessage();
    NumberMessage posted;
    EXPECT_TRUE(workspace.ForceFetchMessage("Mine", &posted));
    EXPECT_EQ(posted.Number, 2);
    EXPECT_EQ(workspace.FindGlobalMessage("Theirs")->GetNumberOfPosts(), 0u);
}

TEST(RabitMessage, FetchesWhatIsPostedUnderItsOwnNameAfterAnAssignment)
{
    RabitWorkspace workspace;
    const auto mine = Registered(workspace, "Mine", 1);
    const auto other = Registered(workspace, "Mine", 4);
    const auto theirs = Registered(workspace, "Theirs", 2);
    theirs->PostMessage();
    *mine = *theirs;
    other->PostMessage();
    EXPECT_TRUE(mine->FetchMessage());
    EXPECT_EQ(mine->Number, 4);
    EXPECT_FALSE(mine->FetchMessage());
}

TEST(RabitMessage, AMoveLeavesTheRegistrationOfBoth)
{
    RabitWorkspace workspace;
    const auto mine = Registered(workspace, "Mine", 1);
    const auto theirs = Registered(workspace, "Theirs", 2);
    *mine = std::move(*theirs);
    EXPECT_EQ(mine->Number, 2);
    EXPECT_EQ(mine->GetGlobalPublishSubscribeMessageRef(), workspace.FindGlobalMessage("Mine"));
    EXPECT_EQ(theirs->GetGlobalPublishSubscribeMessageRef(), workspace.FindGlobalMessage("Theirs"));
    NumberMessage made(std::move(*theirs));
    EXPECT_EQ(made.GetGlobalPublishSubscribeMessageRef(), nullptr);
}

TEST(RabitMessage, ACopyHasTheContentsAndIsUnregistered)
{
    RabitWorkspace workspace;
    const auto message = Registered(workspace, "Name", 2);
    message->PostMessage();
    NumberMessage copy(*message);
    EXPECT_EQ(copy.Number, 2);
    EXPECT_EQ(copy.GetTimeStamp(), message->GetTimeStamp());
    EXPECT_TRUE(copy.WasPosted());
    EXPECT_EQ(copy.GetGlobalPublishSubscribeMessageRef(), nullptr);
    EXPECT_THROW(copy.PostMessage(), GlobalPublishSubscribeException);
}

TEST(RabitMessage, CopyBaseLeavesTheRegistrationOfARegisteredMessage)
{
    RabitWorkspace workspace;
    const auto mine = Registered(workspace, "Mine", 1);
    const auto theirs = Registered(workspace, "Theirs", 2);
    mine->CopyBase(theirs.get());
    EXPECT_EQ(mine->GetGlobalPublishSubscribeMessageRef(), workspace.FindGlobalMessage("Mine"));
    const NumberMessage unregistered;
    mine->CopyBase(&unregistered);
    EXPECT_EQ(mine->GetGlobalPublishSubscribeMessageRef(), workspace.FindGlobalMessage("Mine"));
}

TEST(RabitMessage, CopyBaseRegistersAnUnregisteredMessage)
{
    NumberMessage from;
    from.MessageType = 1;
    from.SetGlobalPublishSubscribeMessageRef(std::make_shared<PublishSubscribeMessage>(from.Clone()));
    NumberMessage to;
    to.CopyBase(&from);
    EXPECT_EQ(to.MessageType, 1);
    EXPECT_EQ(to.GetGlobalPublishSubscribeMessageRef(), from.GetGlobalPublishSubscribeMessageRef());
}

TEST(RabitMessage, CopyingFromNullOrFromAnotherTypeIsRefused)
{
    NumberMessage to;
    AssigningMessage other;
    EXPECT_FALSE(to.CopyMessage(nullptr));
    EXPECT_FALSE(to.CopyMessage(&other));
    to.CopyBase(nullptr);
}

TEST(RabitMessage, ClearZeroesTheBase)
{
    NumberMessage message;
    message.MessageType = 1;
    message.Clear();
    EXPECT_EQ(message.MessageType, 0);
    EXPECT_EQ(message.GetTimeStamp(), 0.0);
    EXPECT_FALSE(message.WasPosted());
}

TEST(RabitMessage, TheBaseTextNamesTheTypeAndDoesNotThrow)
{
    const NumberMessage message;
    EXPECT_NE(message.ToString().find("NumberMessage"), std::string::npos);
}

TEST(RabitMessage, TheBaseHasNoByteFormat)
{
    NumberMessage message;
    std::array<std::uint8_t, 64> buffer{};
    EXPECT_EQ(message.Serialize(buffer.data(), 64), 0);
    EXPECT_EQ(message.DeSerialize(buffer.data(), 64), 0);
}

TEST(RabitMessage, KnowsItsDynamicType)
{
    NumberMessage message;
    RabitMessage &base = message;
    EXPECT_EQ(base.GetTypeIndex(), std::type_index(typeid(NumberMessage)));
}

TEST(RabitMessage, TheHeaderIsTwentyBytesAndComesBack)
{
    NumberMessage message;
    message.MessageType = 1;
    message.MessageSource = -2;
    message.MessageDestination = 0x01020304;
    message.SetTimeStamp(1234.5);
    std::array<std::uint8_t, 20> buffer{};
    ByteArrayWriter writer(buffer.data(), 20, Endian_Big);
    EXPECT_EQ(message.getSerializedMsgHeaderSize(), 20);
    EXPECT_EQ(message.SerializeMsgHeader(writer), 20);
    EXPECT_EQ(buffer[3], 1);
    EXPECT_EQ(buffer[8], 1);
    EXPECT_EQ(buffer[11], 4);
    NumberMessage read;
    ByteArrayReader reader(buffer.data(), 20, Endian_Big);
    EXPECT_EQ(read.DeSerializeMsgHeader(reader), 20);
    EXPECT_EQ(read.MessageSource, -2);
    EXPECT_EQ(read.MessageDestination, 0x01020304);
    EXPECT_EQ(read.GetTimeStamp(), 1234.5);
}

TEST(RabitMessage, AHeaderThatDoesNotFitIsNotWrittenNorRead)
{
    NumberMessage message;
    std::array<std::uint8_t, 19> buffer{};
    ByteArrayWriter writer(buffer.data(), 19, Endian_Big);
    EXPECT_EQ(message.SerializeMsgHeader(writer), 0);
    EXPECT_EQ(writer.Idx, 0);
    ByteArrayReader reader(buffer.data(), 19, Endian_Big);
    EXPECT_EQ(message.DeSerializeMsgHeader(reader), 0);
}

}  // namespace
