// The addresses to which a participant is announced by unicast.
#include "DirectAnnouncements.h"

#include <gtest/gtest.h>

namespace
{

using Rabit::Cyclone::DirectAnnouncements;

constexpr DirectAnnouncements::Address First{10, 0, 0, 1};
constexpr DirectAnnouncements::Address Second{10, 0, 0, 2};

TEST(DirectAnnouncements, OnlyWhoAnnouncesItselfToUsAloneIsAnsweredAlone)
{
    DirectAnnouncements announcements;
    EXPECT_FALSE(announcements.MayGo(First));
    announcements.OnAnnouncement(First);
    EXPECT_TRUE(announcements.MayGo(First));
    EXPECT_FALSE(announcements.MayGo(Second));
}

TEST(DirectAnnouncements, OfManyTheLastAreRemembered)
{
    DirectAnnouncements announcements;
    announcements.OnAnnouncement(First);
    announcements.OnAnnouncement(Second);
    for (std::size_t i = 0; i + 1 < DirectAnnouncements::MostAddresses; ++i)
    {
        announcements.OnAnnouncement(
            {11, 0, static_cast<std::uint8_t>(i >> 8), static_cast<std::uint8_t>(i)});
    }
    EXPECT_FALSE(announcements.MayGo(First));
    EXPECT_TRUE(announcements.MayGo(Second));
}

}  // namespace
