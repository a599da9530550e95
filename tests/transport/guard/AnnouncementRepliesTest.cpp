// A peer that announces itself and has not heard us is answered again.
#include "guard/AnnouncementReplies.h"

#include <gtest/gtest.h>

#include "guard/RtpsBytes.h"

namespace
{

using namespace RtpsBytes;
using namespace std::chrono_literals;
using Rabit::Rtps::AnnouncementReplies;

class AnnouncementRepliesTest : public testing::Test
{
protected:
    AnnouncementReplies Replies{10s};
    AnnouncementReplies::TimePoint Now{1h};
};

TEST_F(AnnouncementRepliesTest, TheFirstAnnouncementIsAnsweredByTheVendor)
{
    EXPECT_FALSE(Replies.OnAnnouncement(Sender, Now));
}

TEST_F(AnnouncementRepliesTest, WhoGoesOnAnnouncingAndSaysNothingToUsIsAnswered)
{
    Replies.OnAnnouncement(Sender, Now);
    EXPECT_TRUE(Replies.OnAnnouncement(Sender, Now + 250ms));
    EXPECT_TRUE(Replies.OnAnnouncement(Sender, Now + 500ms));
}

TEST_F(AnnouncementRepliesTest, ThoseWhoFellSilentMakeRoom)
{
    for (std::size_t i = 0; i < AnnouncementReplies::MostPeers; ++i)
    {
        AnnouncementReplies::TimePoint at = Now + i * 1ms;
        auto peer = Sender;
        peer[0] = static_cast<std::uint8_t>(i);
        peer[1] = static_cast<std::uint8_t>(i >> 8);
        peer[2] = 7;
        Replies.OnAnnouncement(peer, at);
    }
    Replies.OnAnnouncement(Sender, Now + 1min);
    EXPECT_TRUE(Replies.OnAnnouncement(Sender, Now + 1min + 250ms));
}

TEST_F(AnnouncementRepliesTest, WhoSaysSomethingToUsHasHeardUs)
{
    Replies.OnAnnouncement(Sender, Now);
    Replies.OnAddressed(Sender);
    EXPECT_FALSE(Replies.OnAnnouncement(Sender, Now + 10s));
}

TEST_F(AnnouncementRepliesTest, OneAnnouncementAnswersAllWhoWait)
{
    Replies.OnAnnouncement(Sender, Now);
    Replies.OnAnnouncement(Other, Now);
    EXPECT_TRUE(Replies.OnAnnouncement(Sender, Now + 250ms));
    EXPECT_FALSE(Replies.OnAnnouncement(Other, Now + 349ms));
    EXPECT_TRUE(Replies.OnAnnouncement(Other, Now + 350ms));
}

TEST_F(AnnouncementRepliesTest, WhoHasNothingToSayIsNotAnsweredForEver)
{
    Replies.OnAnnouncement(Sender, Now);
    int replies = 0;
    for (int i = 1; i < 100; ++i)
    {
        replies += Replies.OnAnnouncement(Sender, Now + i * 1s) ? 1 : 0;
    }
    EXPECT_EQ(replies, AnnouncementReplies::MostForOne);
}

TEST_F(AnnouncementRepliesTest, WhoWasSilentForLongMayHaveForgottenUs)
{
    Replies.OnAnnouncement(Sender, Now);
    Replies.OnAddressed(Sender);
    EXPECT_FALSE(Replies.OnAnnouncement(Sender, Now + 24999ms));
    EXPECT_TRUE(Replies.OnAnnouncement(Sender, Now + 49999ms));
}

TEST_F(AnnouncementRepliesTest, WhoAnnouncesItselfOnceInALongPeriodHasNotForgottenUs)
{
    AnnouncementReplies rare{60s};
    rare.OnAnnouncement(Sender, Now);
    rare.OnAddressed(Sender);
    EXPECT_FALSE(rare.OnAnnouncement(Sender, Now + 60s));
    EXPECT_FALSE(rare.OnAnnouncement(Sender, Now + 180s));  // one was lost
    EXPECT_TRUE(rare.OnAnnouncement(Sender, Now + 330s));
}

TEST_F(AnnouncementRepliesTest, WhoWasSilentForAShortPeriodMayBeBusy)
{
    AnnouncementReplies often{500ms};
    often.OnAnnouncement(Sender, Now);
    often.OnAddressed(Sender);
    EXPECT_FALSE(often.OnAnnouncement(Sender, Now + 14999ms));
    EXPECT_TRUE(often.OnAnnouncement(Sender, Now + 29999ms));
}

TEST_F(AnnouncementRepliesTest, WhoWasGoneIsNew)
{
    Replies.OnAnnouncement(Sender, Now);
    Replies.OnAddressed(Sender);
    Replies.OnGone(Sender);
    EXPECT_FALSE(Replies.OnAnnouncement(Sender, Now + 1s));
    EXPECT_TRUE(Replies.OnAnnouncement(Sender, Now + 2s));
}

TEST_F(AnnouncementRepliesTest, StrangersWithoutEndDoNotFillTheMemory)
{
    Rabit::Rtps::GuidPrefix stranger = Other;
    for (std::size_t i = 0; i < AnnouncementReplies::MostPeers; ++i)
    {
        stranger[0] = static_cast<std::uint8_t>(i);
        stranger[1] = static_cast<std::uint8_t>(i >> 8);
        Replies.OnAnnouncement(stranger, Now);
    }
    Replies.OnAnnouncement(Sender, Now);
    EXPECT_FALSE(Replies.OnAnnouncement(Sender, Now + 1s));
}

}  // namespace
