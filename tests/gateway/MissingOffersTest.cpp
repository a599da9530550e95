#include "presence/MissingOffers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "wire/Announcements.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using Ns = std::chrono::nanoseconds;

std::string Names(const std::vector<MissingOffers::Question> &questions)
{
    std::string names;
    for (const auto &question : questions)
    {
        names += question.Node;
    }
    return names;
}

TEST(MissingOffers, ItMayBeOnItsWaySoNobodyIsAskedAtOnce)
{
    MissingOffers missing;
    EXPECT_EQ(missing.NextDue(), std::nullopt);
    missing.Lacks("a", 1, 10s);
    EXPECT_EQ(missing.NextDue(), Ns(10s + MissingOffers::AskAfter));
    EXPECT_EQ(Names(missing.Take(10s, 8)), "");
    EXPECT_EQ(Names(missing.Take(10s + MissingOffers::AskAfter, 8)), "a");
}

TEST(MissingOffers, WhoDoesNotAnswerIsAskedMoreAndMoreSeldom)
{
    MissingOffers missing;
    missing.Lacks("a", 1, 0s);
    std::vector<Ns> gaps;
    for (Ns last = 0s; gaps.size() < 28;)
    {
        const Ns next = *missing.NextDue();
        ASSERT_EQ(missing.Take(next, 8).size(), 1u);
        missing.Lacks("a", 1, next);
        gaps.push_back(next - last);
        last = next;
    }
    std::vector<Ns> expected{60ms, 120ms};
    expected.resize(1 + MissingOffers::QuickQuestions, 150ms);
    expected.insert(expected.end(),
                    {225ms, 337'500us, 506'250us, 759'375us, 1'139'062'500ns, 1'708'593'750ns, 2s});
    EXPECT_EQ(gaps, expected);
}

TEST(MissingOffers, WhoSaysThatItOffersSomethingElseIsNotAskedMoreOftenForIt)
{
    MissingOffers missing;
    int asked = 0;
    for (int i = 0; i < 1000; ++i)
    {
        missing.Lacks("a", static_cast<std::uint32_t>(i), i * 10ms);
        asked += missing.Take(i * 10ms, 8).empty() ? 0 : 1;
    }
    EXPECT_LE(asked, MissingOffers::QuickQuestions + 8);  // 10 s, the quick ones 3 s of it
}

TEST(MissingOffers, NobodyIsAskedWhoWasLetGo)
{
    MissingOffers missing;
    missing.Lacks("a", 1, 0s);
    missing.LetGo("a");
    EXPECT_EQ(missing.NextDue(), std::nullopt);
}

TEST(MissingOffers, ThoseWhoAreAskedTakeTurns)
{
    MissingOffers missing;
    for (const char *node : {"a", "b", "c"})
    {
        missing.Lacks(node, 1, 0s);
    }
    EXPECT_EQ(missing.Due(1s, 2), 2u);
    EXPECT_EQ(Names(missing.Take(1s, 2)), "ab");
    EXPECT_EQ(missing.Due(1s, 2), 1u);
    EXPECT_EQ(Names(missing.Take(1s, 2)), "c");
    EXPECT_EQ(Names(missing.Take(1s, 2)), "");
}

TEST(MissingOffers, AsksFromTheFirstByteOnThatIsLacking)
{
    const std::vector<std::uint8_t> whole(200, 7);
    MissingOffers missing;
    missing.Lacks("a", Announcements::DigestOf(whole), 0s);
    Gateway::AnnouncementPart part;
    part.of = 200;
    part.bytes.assign(120, 7);
    EXPECT_EQ(missing.Add("a", part), std::nullopt);
    EXPECT_EQ(missing.Take(1s, 8).at(0).From, 120);
    part.first = 120;
    part.bytes.assign(80, 7);
    EXPECT_EQ(missing.Add("a", part), whole);
}

TEST(MissingOffers, PartsOfWhatIsNotLackingAreNotCollected)
{
    MissingOffers missing;
    Gateway::AnnouncementPart part;
    part.of = 1;
    part.bytes = {7};
    EXPECT_EQ(missing.Add("a", part), std::nullopt);
    EXPECT_EQ(missing.Wrong(), 0u);
}

TEST(QuickMissingOffers, AreAskedForEvenlyAtFirstAndThenLessAndLess)
{
    using namespace std::chrono_literals;
    MissingOffers missing;
    missing.BeQuick(250ms, 5);
    missing.Lacks("uav1", 1, 0s);
    std::vector<MissingOffers::Duration> gaps;
    for (auto last = *missing.NextDue(); gaps.size() < 9;)
    {
        missing.Take(last, 8);
        gaps.push_back(*missing.NextDue() - last);
        last = *missing.NextDue();
    }
    EXPECT_THAT(gaps, ::testing::ElementsAre(120ms, 180ms, 250ms, 250ms, 250ms, 375ms, 562'500us, 843'750us,
                                             1'265'625us));
}

TEST(MissingOffers, WhatWaitsInQueuesIsNotAskedForAgainBeforeItCanHaveCome)
{
    MissingOffers missing;
    missing.Lacks("a", 1, 0s);
    ASSERT_EQ(missing.Take(1s, 8, 700ms).size(), 1u);
    EXPECT_EQ(missing.NextDue(), Ns(1s + 2 * 700ms));
}

}  // namespace
}  // namespace Rabit
