#include "TestManagers.h"
#include "TestMessages.h"
#include "TypedMessages.h"

#include <rabit/GlobalPublishSubscribeException.h>
#include <rabit/ManualClock.h>
#include <rabit/PublishSubscribeMessage.h>
#include <rabit/RabitWorkspace.h>

#include <gtest/gtest.h>

#include <atomic>
#include <limits>
#include <memory>
#include <stdexcept>
#include <thread>

namespace
{

using namespace Rabit;
using namespace RabitTest;
using namespace std::chrono_literals;

// Two local copies of one name in a workspace whose clock stands still.
template <typename Message>
struct Pair
{
    std::shared_ptr<ManualClock> Clock = std::make_shared<ManualClock>(1000.0);
    RabitWorkspace Workspace{Clock};
    std::shared_ptr<Message> Poster = std::make_shared<Message>();
    std::shared_ptr<Message> Reader = std::make_shared<Message>();

    Pair()
    {
        Workspace.AddPublishSubscribeMessage("Name", Poster);
        Workspace.AddPublishSubscribeMessage("Name", Reader);
    }
};

// A message whose override copies all, one that copies nothing of the base, and one that returns false for
// its own type.
template <typename Message>
class AnyOverride : public testing::Test
{
};
using Overrides = testing::Types<NumberMessage, ForgetfulMessage, DenyingMessage>;
TYPED_TEST_SUITE(AnyOverride, Overrides);

TYPED_TEST(AnyOverride, AFetchAfterAPostBringsItsContentsOnce)
{
    Pair<TypeParam> pair;
    pair.Poster->Number = 7;
    pair.Poster->PostMessage();
    EXPECT_TRUE(pair.Reader->FetchMessage());
    EXPECT_EQ(pair.Reader->Number, 7);
    EXPECT_TRUE(pair.Reader->CompareTime(pair.Poster.get()));
    EXPECT_FALSE(pair.Reader->FetchMessage());
}

TEST(PublishSubscribe, SetTimeNowStampsByTheClockOfTheWorkspace)
{
    Pair<NumberMessage> pair;
    pair.Poster->SetTimeNow();
    EXPECT_EQ(pair.Poster->GetTimeStamp(), 1000.0);
}

TEST(PublishSubscribe, OfTwoPostersOfOneNameTheLastCountsAndTheOtherFetchesIt)
{
    Pair<NumberMessage> pair;
    const auto third = std::make_shared<NumberMessage>();
    pair.Workspace.AddPublishSubscribeMessage("Name", third);
    pair.Poster->Number = 1;
    pair.Poster->PostMessage();
    third->Number = 2;
    third->PostMessage();
    EXPECT_TRUE(pair.Poster->FetchMessage());
    EXPECT_EQ(pair.Poster->Number, 2);
    EXPECT_FALSE(third->FetchMessage());
    EXPECT_TRUE(pair.Reader->FetchMessage());
    EXPECT_EQ(pair.Reader->Number, 2);
}

TEST(PublishSubscribe, ThePostersOwnFetchIsFalse)
{
    Pair<NumberMessage> pair;
    pair.Poster->PostMessage();
    EXPECT_FALSE(pair.Poster->FetchMessage());
}

TEST(PublishSubscribe, TwoPostsWithinOneTickOfTheClockAreBothSeen)
{
    Pair<NumberMessage> pair;
    pair.Poster->Number = 1;
    pair.Poster->PostMessage();
    ASSERT_TRUE(pair.Reader->FetchMessage());
    pair.Poster->Number = 2;
    pair.Poster->PostMessage();
    EXPECT_TRUE(pair.Reader->FetchMessage());
    EXPECT_EQ(pair.Reader->Number, 2);
}

TEST(PublishSubscribe, TimeStampsOfOneNameStrictlyIncreaseWhenTheClockStandsStill)
{
    Pair<NumberMessage> pair;
    double last = 0.0;
    for (int i = 0; i < 1000000; ++i)  // far more than a clock of this computer would be allowed to lag
    {
        pair.Poster->PostMessage();
        ASSERT_GT(pair.Poster->GetTimeStamp(), last);
        last = pair.Poster->GetTimeStamp();
    }
}

TEST(PublishSubscribe, TimeStampsFollowAWallClockThatIsSetBack)
{
    Pair<NumberMessage> pair;
    pair.Poster->PostMessage();
    pair.Clock->SetGpsTimeSeconds(400.0);
    pair.Poster->PostMessage();
    EXPECT_EQ(pair.Poster->GetTimeStamp(), 400.0);
    EXPECT_TRUE(pair.Reader->FetchMessage());
    pair.Clock->Advance(1s);
    pair.Reader->PostMessage();
    EXPECT_EQ(pair.Reader->GetTimeStamp(), 401.0);
}

// A message that reads its own attachment while it is copied, as another thread may at any time.
class WatchingMessage : public NumberMessage
{
public:
    bool WasAttached = false;

    std::unique_ptr<RabitMessage> Clone() const override { return std::make_unique<WatchingMessage>(*this); }
    bool CopyMessage(RabitMessage *msg) override
    {
        WasAttached = GetGlobalPublishSubscribeMessageRef() != nullptr;
        return NumberMessage::CopyMessage(msg);
    }
};

TEST(PublishSubscribe, AMessageStaysAttachedWhileAFetchCopiesToIt)
{
    Pair<WatchingMessage> pair;
    pair.Poster->PostMessage();
    ASSERT_TRUE(pair.Reader->FetchMessage());
    EXPECT_TRUE(pair.Reader->WasAttached);
}

TEST(PublishSubscribe, TheFirstFetchOfALaterSubscriberIsTrueWhenSomethingWasPosted)
{
    Pair<NumberMessage> pair;
    pair.Poster->Number = 3;
    pair.Poster->PostMessage();
    const auto later = std::make_shared<NumberMessage>();
    later->SetTimeStamp(pair.Poster->GetTimeStamp());  // the very tick of the post
    pair.Workspace.AddPublishSubscribeMessage("Name", later);
    EXPECT_TRUE(later->FetchMessage());
    EXPECT_EQ(later->Number, 3);
}

TEST(PublishSubscribe, TheFirstFetchOfALaterSubscriberIsTrueEvenIfNothingWasPosted)
{
    RabitWorkspace workspace;
    const auto first = std::make_shared<NumberMessage>();
    first->Number = 5;
    const auto later = std::make_shared<NumberMessage>();
    later->SetTimeStamp(first->GetTimeStamp());
    workspace.AddPublishSubscribeMessage("Name", first);
    workspace.AddPublishSubscribeMessage("Name", later);
    EXPECT_FALSE(first->FetchMessage());
    EXPECT_TRUE(later->FetchMessage());
    EXPECT_EQ(later->Number, 5);
    EXPECT_FALSE(later->WasPosted());
    EXPECT_FALSE(later->FetchMessage());
}

TEST(PublishSubscribe, ACloneWithAnEqualStampIsNotFetchedToAndOneWithAnotherIs)
{
    NumberMessage original;
    original.Number = 5;
    PublishSubscribeMessage global(original.Clone());
    const auto clone = original.Clone();
    EXPECT_FALSE(global.FetchMessage(clone.get()));
    clone->SetTimeStamp(clone->GetTimeStamp() + 1.0);
    EXPECT_TRUE(global.FetchMessage(clone.get()));
    EXPECT_TRUE(clone->CompareTime(global.GetTestMessage().get()));
}

TEST(PublishSubscribe, APostGivesTheGlobalCopyThePostersStamp)
{
    NumberMessage poster;
    PublishSubscribeMessage global(poster.Clone());
    global.PostMessage(&poster);
    EXPECT_TRUE(poster.CompareTime(global.GetTestMessage().get()));
}

TEST(PublishSubscribe, AStampThatATestChangesInTheGlobalCopyCountsAsNew)
{
    NumberMessage poster;
    PublishSubscribeMessage global(poster.Clone());
    global.PostMessage(&poster);
    global.GetTestMessage()->SetTimeStamp(5.0);
    EXPECT_TRUE(global.FetchMessage(&poster));
    EXPECT_EQ(poster.GetTimeStamp(), 5.0);
}

TEST(PublishSubscribe, AStampChangedByHandCountsAsNew)
{
    Pair<NumberMessage> pair;
    pair.Poster->PostMessage();
    pair.Reader->FetchMessage();
    pair.Reader->SetTimeStamp(1.0);
    EXPECT_TRUE(pair.Reader->FetchMessage());
}

TEST(PublishSubscribe, AnOverrideThatAssignsTheWholeObjectKeepsTheMessageAttached)
{
    Pair<AssigningMessage> pair;
    const auto global = pair.Poster->GetGlobalPublishSubscribeMessageRef();
    pair.Poster->Text = "first";
    pair.Poster->PostMessage();
    EXPECT_TRUE(pair.Reader->FetchMessage());
    EXPECT_EQ(pair.Reader->GetGlobalPublishSubscribeMessageRef(), global);
    EXPECT_FALSE(pair.Reader->FetchMessage());
    pair.Reader->Text = "second";
    pair.Reader->PostMessage();
    EXPECT_TRUE(pair.Poster->FetchMessage());
    EXPECT_EQ(pair.Poster->Text, "second");
}

TEST(PublishSubscribe, AnOverrideThatUsesCopyBaseKeepsTheMessageAttached)
{
    Pair<BaseCopyingMessage> pair;
    const auto global = pair.Poster->GetGlobalPublishSubscribeMessageRef();
    pair.Poster->Number = 1;
    pair.Poster->PostMessage();
    EXPECT_TRUE(pair.Reader->FetchMessage());
    EXPECT_EQ(pair.Reader->Number, 1);
    EXPECT_EQ(pair.Reader->GetGlobalPublishSubscribeMessageRef(), global);
}

TEST(PublishSubscribe, AnOverrideThatUsesCopyBaseDoesNotMakeTheGlobalCopyOwnItself)
{
    std::weak_ptr<PublishSubscribeMessage> global;
    {
        Pair<BaseCopyingMessage> pair;
        pair.Poster->PostMessage();
        pair.Reader->FetchMessage();
        global = pair.Poster->GetGlobalPublishSubscribeMessageRef();
    }
    EXPECT_TRUE(global.expired());
}

TEST(PublishSubscribe, ForceFetchCopiesInAnyCase)
{
    Pair<NumberMessage> pair;
    pair.Poster->Number = 4;
    pair.Poster->PostMessage();
    pair.Reader->FetchMessage();
    pair.Reader->Number = 0;
    EXPECT_TRUE(pair.Workspace.ForceFetchMessage("Name", pair.Reader.get()));
    EXPECT_EQ(pair.Reader->Number, 4);
}

TEST(PublishSubscribe, HandlersMayPostAndFetchTheSameName)
{
    Pair<NumberMessage> pair;
    int calls = 0;
    pair.Poster->Register_SomethingPublished(
        [&]
        {
            if (++calls == 1)
            {
                pair.Reader->FetchMessage();
                pair.Reader->Number += 1;
                pair.Reader->PostMessage();
            }
        });
    pair.Poster->Number = 1;
    pair.Poster->PostMessage();
    EXPECT_EQ(calls, 2);
    EXPECT_TRUE(pair.Poster->FetchMessage());
    EXPECT_EQ(pair.Poster->Number, 2);
}

// A message whose copying the test can hold up, under the global copy's lock, or let fail.
class TroublesomeMessage : public NumberMessage
{
public:
    struct Trouble
    {
        std::atomic<bool> HoldUp{false};
        std::atomic<bool> HeldUp{false};
        std::atomic<bool> Throw{false};
    };
    std::shared_ptr<Trouble> What = std::make_shared<Trouble>();

    std::unique_ptr<RabitMessage> Clone() const override
    {
        return std::make_unique<TroublesomeMessage>(*this);
    }
    bool CopyMessage(RabitMessage *msg) override
    {
        if (What->Throw)
        {
            throw std::runtime_error("cannot copy");
        }
        while (What->HoldUp)
        {
            What->HeldUp = true;
            std::this_thread::yield();
        }
        return NumberMessage::CopyMessage(msg);
    }
};

TEST(PublishSubscribe, AFetchWithNothingNewDoesNotWaitForTheLock)
{
    Pair<TroublesomeMessage> pair;
    pair.Poster->PostMessage();
    pair.Reader->FetchMessage();
    // The global copy is a clone of the poster's message and shares its troubles.
    pair.Poster->What->HoldUp = true;
    std::thread posting([&] { pair.Poster->PostMessage(); });
    ASSERT_TRUE(Eventually([&] { return pair.Poster->What->HeldUp.load(); }));
    EXPECT_FALSE(pair.Reader->FetchMessage());
    pair.Poster->What->HoldUp = false;
    posting.join();
    EXPECT_TRUE(pair.Reader->FetchMessage());
}

TEST(PublishSubscribe, APostWhoseCopyingThrowsDidNotHappen)
{
    Pair<TroublesomeMessage> pair;
    pair.Poster->PostMessage();
    pair.Reader->FetchMessage();
    const double stamp = pair.Poster->GetTimeStamp();
    pair.Poster->What->Throw = true;
    EXPECT_THROW(pair.Poster->PostMessage(), std::runtime_error);
    EXPECT_EQ(pair.Poster->GetTimeStamp(), stamp);
    EXPECT_FALSE(pair.Reader->FetchMessage());
    pair.Poster->What->Throw = false;
    pair.Poster->PostMessage();
    EXPECT_TRUE(pair.Reader->FetchMessage());
}

TEST(PublishSubscribe, AMessageOfAnotherTypeIsNotPosted)
{
    NumberMessage number;
    PublishSubscribeMessage global(number.Clone());
    AssigningMessage other;
    const double stamp = other.GetTimeStamp();
    EXPECT_THROW(global.PostMessage(&other), std::invalid_argument);
    EXPECT_EQ(global.GetNumberOfPosts(), 0u);
    EXPECT_EQ(other.GetTimeStamp(), stamp);
    EXPECT_FALSE(global.FetchMessage(&other));
}

TEST(PublishSubscribe, AMessageOfAnotherTypeOfTheSameClassIsNotPosted)
{
    PublishSubscribeMessage global(std::make_unique<ManyTypedMessage>("one"));
    ManyTypedMessage other("other");
    EXPECT_THROW(global.PostMessage(&other), std::invalid_argument);
    EXPECT_EQ(global.GetNumberOfPosts(), 0u);
    EXPECT_FALSE(global.FetchMessage(&other));
}

TEST(PublishSubscribe, AnUnregisteredMessageThrows)
{
    NumberMessage message;
    EXPECT_THROW(message.PostMessage(), GlobalPublishSubscribeException);
    EXPECT_THROW(message.FetchMessage(), GlobalPublishSubscribeException);
    EXPECT_THROW(message.Register_SomethingPublished([] {}), GlobalPublishSubscribeException);
}

TEST(PublishSubscribe, APostWithAGivenTimeKeepsItAndIsNeverMissedThoughTheTimeRepeatsOrGoesBack)
{
    Pair<NumberMessage> pair;
    for (const double stamp : {500.0, 500.0, 400.0})
    {
        pair.Poster->PostMessage(PostTime{stamp, 3s});
        EXPECT_TRUE(pair.Reader->FetchMessage());
        EXPECT_EQ(pair.Reader->GetTimeStamp(), stamp);
    }
}

// Posts contents to the name of a pair, by a message that belongs to the poster alone.
struct ContentsPoster
{
    std::unique_ptr<RabitMessage> Message = std::make_unique<NumberMessage>();

    NumberMessage &Number() { return static_cast<NumberMessage &>(*Message); }
    void Post(Pair<NumberMessage> &pair, int number, const PostTime &time)
    {
        Number().Number = number;
        pair.Poster->GetGlobalPublishSubscribeMessageRef()->PostContents(Message, time);
    }
};

TEST(PublishSubscribe, PostedContentsAreFetchedWithTheirTimeAndCallTheHandlers)
{
    Pair<NumberMessage> pair;
    ContentsPoster poster;
    int calls = 0;
    pair.Reader->Register_SomethingPublished([&calls] { ++calls; });
    for (const int number : {7, 8, 9})
    {
        poster.Post(pair, number, PostTime{500.0, 3s});
        EXPECT_TRUE(pair.Reader->FetchMessage());
        EXPECT_EQ(pair.Reader->Number, number);
        EXPECT_EQ(pair.Reader->GetTimeStamp(), 500.0);
        EXPECT_FALSE(pair.Reader->FetchMessage());
    }
    EXPECT_EQ(calls, 3);
}

TEST(PublishSubscribe, APosterOfContentsGetsThoseOfThePostBefore)
{
    Pair<NumberMessage> pair;
    ContentsPoster poster;
    poster.Post(pair, 7, PostTime{500.0, 3s});
    poster.Post(pair, 8, PostTime{501.0, 3s});
    EXPECT_EQ(poster.Number().Number, 7);
}

TEST(PublishSubscribe, APosterOfContentsStaysRegisteredAndTheGlobalCopyDoesNot)
{
    Pair<NumberMessage> pair;
    ContentsPoster poster;
    const std::weak_ptr<PublishSubscribeMessage> global = pair.Poster->GetGlobalPublishSubscribeMessageRef();
    poster.Message->SetGlobalPublishSubscribeMessageRef(global.lock());
    poster.Post(pair, 7, PostTime{500.0, 3s});
    EXPECT_EQ(poster.Message->GetGlobalPublishSubscribeMessageRef(), global.lock());
    EXPECT_FALSE(global.lock()->GetTestMessage()->GetGlobalPublishSubscribeMessageRef());
}

TEST(PublishSubscribe, AGlobalCopyThatATestHoldsStaysWhereItIsWhenContentsArePosted)
{
    Pair<NumberMessage> pair;
    ContentsPoster poster;
    const auto global = pair.Poster->GetGlobalPublishSubscribeMessageRef();
    const auto *held = dynamic_cast<const NumberMessage *>(global->GetTestMessage().get());
    poster.Post(pair, 7, PostTime{500.0, 3s});
    EXPECT_EQ(global->GetTestMessage().get(), held);
    EXPECT_EQ(held->Number, 7);
}

TEST(PublishSubscribe, ContentsOfAnotherTypeAreNotPosted)
{
    Pair<NumberMessage> pair;
    const auto global = pair.Poster->GetGlobalPublishSubscribeMessageRef();
    std::unique_ptr<RabitMessage> other = std::make_unique<AssigningMessage>();
    std::unique_ptr<RabitMessage> none;
    EXPECT_THROW(global->PostContents(other, PostTime{500.0, 3s}), std::invalid_argument);
    EXPECT_THROW(global->PostContents(none, PostTime{500.0, 3s}), std::invalid_argument);
    EXPECT_EQ(global->GetNumberOfPosts(), 0u);
}

TEST(MessageAge, IsTheTimeSinceThePostByTheMonotonicClockWhateverTheWallClockDoes)
{
    Pair<NumberMessage> pair;
    pair.Poster->PostMessage();
    pair.Clock->Advance(250ms);
    pair.Clock->SetGpsTimeSeconds(5.0);
    pair.Reader->FetchMessage();
    EXPECT_DOUBLE_EQ(pair.Reader->GetAgeSeconds(), 0.25);
    EXPECT_DOUBLE_EQ(pair.Poster->GetAgeSeconds(), 0.25);
}

TEST(MessageAge, IsInfiniteForContentsThatWereNeverPosted)
{
    Pair<NumberMessage> pair;
    EXPECT_FALSE(pair.Reader->WasPosted());
    EXPECT_EQ(pair.Reader->GetAgeSeconds(), std::numeric_limits<double>::infinity());
}

TEST(MessageAge, OfAMirroredMessageCountsFromItsOrigin)
{
    Pair<NumberMessage> pair;
    pair.Clock->Advance(10s);
    pair.Poster->PostMessage(PostTime{123.0, 9s});
    pair.Reader->FetchMessage();
    EXPECT_DOUBLE_EQ(pair.Reader->GetAgeSeconds(), 1.0);
}

}  // namespace
