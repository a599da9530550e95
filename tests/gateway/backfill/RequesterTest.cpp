#include "backfill/Requester.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <set>

#include "backfill/PostAnswers.h"
#include "backfill/PostsCodec.h"

namespace Rabit::Backfill
{
namespace
{

using namespace std::chrono_literals;

class RequesterTest : public testing::Test
{
protected:
    RequesterTest() { requester.SetNode("uav1", 7, true, {"Pose"}, 0s); }

    static Answer AnswerTo(const Question &question)
    {
        Answer answer;
        answer.kind = question.kind;
        answer.number = question.number;
        answer.name = question.name;
        answer.incarnation = question.incarnation;
        answer.from = question.from;
        answer.to = question.to;
        return answer;
    }
    // Tells the spans, and returns the question for posts.
    Question AskForPosts()
    {
        const auto spans = requester.Due(0s);
        Answer answer = AnswerTo(spans.at(0).What);
        answer.bytes = PostsCodec::EncodeSpans({{7, {1000, 2000}}});
        requester.Answered("uav1", answer, record, 0s);
        return requester.Due(0s).at(0).What;
    }
    Answer WithPost(const Question &question, std::int64_t time) const
    {
        Answer answer = AnswerTo(question);
        answer.bytes = PostsCodec::EncodePosts({{time, {1}}}, question.from);
        return answer;
    }

    Ledger ledger;
    Requester requester{ledger, 3600s, 100};
    bool hasRoom = true;
    bool isCredible = true;
    std::vector<Post> recorded;
    Requester::Record record = [this](const Series &, const Post &post)
    {
        if (hasRoom && isCredible)
        {
            recorded.push_back(post);
        }
        return !isCredible ? Requester::Taken::Refused
               : hasRoom   ? Requester::Taken::Recorded
                           : Requester::Taken::NotNow;
    };
};

TEST_F(RequesterTest, ANodeIsAskedFirstWhatItHas)
{
    const auto due = requester.Due(0s);
    ASSERT_EQ(due.size(), 1U);
    EXPECT_EQ(due[0].What.kind, Kind::SPANS);
    EXPECT_EQ(due[0].What.to, 3600U);
    EXPECT_TRUE(requester.Due(1s).empty()) << "one question at a time";
}

TEST_F(RequesterTest, ThenForThePosts)
{
    const Question question = AskForPosts();
    EXPECT_EQ(question.kind, Kind::POSTS);
    EXPECT_EQ(question.incarnation, 7U);
    EXPECT_EQ((Range{question.from, question.to}), (Range{1000, 2000}));
    const auto whole = requester.Answered("uav1", WithPost(question, TimeOf(1500) + 3), record, 1s);
    ASSERT_TRUE(whole);
    EXPECT_EQ(whole->second, (Range{1000, 2000}));
    EXPECT_EQ(recorded, (std::vector<Post>{{TimeOf(1500) + 3, {1}}}));
    EXPECT_TRUE(requester.Due(1s).empty()) << "nothing is missing";
}

TEST_F(RequesterTest, ASecondAnswerRecordsNothing)
{
    const Question question = AskForPosts();
    requester.Answered("uav1", WithPost(question, TimeOf(1500)), record, 1s);
    EXPECT_FALSE(requester.Answered("uav1", WithPost(question, TimeOf(1600)), record, 1s));
    EXPECT_EQ(recorded.size(), 1U);
    EXPECT_EQ(requester.Malformed(), 1U);
}

TEST_F(RequesterTest, PostsOutsideOfTheQuestionAreRefused)
{
    const Question question = AskForPosts();
    Answer answer = WithPost(question, TimeOf(1500));
    answer.to = 3000;
    EXPECT_FALSE(requester.Answered("uav1", answer, record, 1s));
    EXPECT_TRUE(recorded.empty());
    EXPECT_EQ(requester.Malformed(), 1U);
}

TEST_F(RequesterTest, AnAnswerToAnEarlierQuestionIsNotTaken)
{
    Question question = AskForPosts();
    --question.number;
    EXPECT_FALSE(requester.Answered("uav1", WithPost(question, TimeOf(1500)), record, 1s));
    EXPECT_TRUE(recorded.empty());
}

TEST_F(RequesterTest, AnotherNodeCannotAnswer)
{
    const Question question = AskForPosts();
    EXPECT_FALSE(requester.Answered("uav2", WithPost(question, TimeOf(1500)), record, 1s));
    EXPECT_TRUE(recorded.empty());
}

TEST_F(RequesterTest, WithoutRoomTheRangeIsAskedForAgain)
{
    const Question question = AskForPosts();
    hasRoom = false;
    EXPECT_FALSE(requester.Answered("uav1", WithPost(question, TimeOf(1500)), record, 1s));
    EXPECT_TRUE(requester.Due(2s).empty());
    hasRoom = true;
    const auto due = requester.Due(1s + Requester::Pause);
    ASSERT_EQ(due.size(), 1U);
    requester.Answered("uav1", WithPost(due[0].What, TimeOf(1500)), record, 32s);
    EXPECT_EQ(recorded.size(), 1U);
}

TEST_F(RequesterTest, ARangeWithAPostThatIsNotRecordedIsNotWholeAndNotAskedForAgain)
{
    const Question question = AskForPosts();
    isCredible = false;
    EXPECT_FALSE(requester.Answered("uav1", WithPost(question, TimeOf(1500)), record, 1s));
    EXPECT_EQ(requester.Recorded(), 0U);
    EXPECT_TRUE(requester.Due(2s + Requester::Pause).empty());
}

// Has one large post, and posts around it.
class LargePostStore final : public PostStore
{
public:
    static constexpr std::size_t Size = 450'000;

    std::optional<std::vector<PostsCodec::Span>> Spans(const std::string &, std::uint64_t) override
    {
        return std::vector<PostsCodec::Span>{{7, {1000, 2000}, true}};
    }
    Found Read(const std::string &, std::uint64_t, Range range, const std::vector<Stamp> &had,
               std::size_t) override
    {
        for (const Stamp stamp : {Stamp{1800}, Stamp{1500}, Stamp{1200}})
        {
            if (range.Contains(stamp) && !std::binary_search(had.begin(), had.end(), stamp))
            {
                return {.First = stamp, .Posts = {{TimeOf(stamp) + 3, Bytes(stamp)}}};
            }
        }
        return {.First = range.First, .Posts = {}};
    }
    std::uint64_t Present() const override { return 8; }

    static std::vector<std::uint8_t> Bytes(Stamp stamp)
    {
        std::vector<std::uint8_t> bytes(stamp == 1500 ? Size : 10);
        for (std::size_t i = 0; i < bytes.size(); ++i)
        {
            bytes[i] = static_cast<std::uint8_t>(i * 7 + i / 256);
        }
        return bytes;
    }
};

class LargePostTest : public RequesterTest
{
protected:
    // Asks and answers over a channel of so many bytes a second, until nothing more is asked for. An answer
    // that would take longer than two minutes does not come. Returns the bytes that were sent.
    std::size_t RunAt(double rate, Requester::Duration end)
    {
        std::size_t sent = 0;
        Requester::Duration now{0};
        while (now < end && recorded.size() < 3)
        {
            const auto due = requester.Due(now);
            if (due.empty())
            {
                now += 1s;
                continue;
            }
            const Answer answer = answers.Of("ground", due[0].What);
            const auto takes = std::chrono::duration_cast<Requester::Duration>(
                std::chrono::duration<double>(static_cast<double>(answer.bytes.size() + 100) / rate));
            sent += answer.bytes.size();
            now += std::min<Requester::Duration>(takes, 121s);
            if (takes < 120s)
            {
                requester.Answered("uav1", answer, record, now);
            }
        }
        return sent;
    }

    LargePostStore store;
    PostAnswers answers{store, [](const std::string &, const std::string &) { return true; },
                        [](const std::string &) { return true; }};
};

TEST_F(LargePostTest, ComesInPartsAndOlderPostsAfterIt)
{
    const std::size_t sent = RunAt(3000, 24h);
    ASSERT_EQ(recorded.size(), 3U);
    EXPECT_EQ(recorded[1], (Post{TimeOf(1500) + 3, LargePostStore::Bytes(1500)}));
    EXPECT_EQ(recorded[2].SourceTime, TimeOf(1200) + 3);
    EXPECT_LT(sent, LargePostStore::Size + 1000) << "nothing travels twice";
}

TEST_F(LargePostTest, ComesOverAChannelThatTakesLongerForAnAnswerThanItIsWaitedFor)
{
    RunAt(60, 1000h);
    ASSERT_EQ(recorded.size(), 3U);
    EXPECT_EQ(recorded[1], (Post{TimeOf(1500) + 3, LargePostStore::Bytes(1500)}));
}

TEST_F(LargePostTest, IsAskedForFromItsBeginningIfItIsAnotherOneNow)
{
    Question question = AskForPosts();
    requester.Answered("uav1", answers.Of("ground", question), record, 0s);  // the one of 1800
    question = requester.Due(1s).at(0).What;
    requester.Answered("uav1", answers.Of("ground", question), record, 1s);
    question = requester.Due(2s).at(0).What;
    EXPECT_EQ(question.offset, PostAnswers::LargestAnswer);
    Answer other = answers.Of("ground", question);
    ++other.size;
    requester.Answered("uav1", other, record, 2s);
    EXPECT_EQ(requester.Malformed(), 1U);
    EXPECT_EQ(requester.Due(2s + Requester::Pause).at(0).What.offset, 0U);
}

TEST_F(LargePostTest, IsGivenUpIfItsFileIsDamagedMeanwhile)
{
    Question question = AskForPosts();
    requester.Answered("uav1", answers.Of("ground", question), record, 0s);  // the one of 1800
    question = requester.Due(1s).at(0).What;
    requester.Answered("uav1", answers.Of("ground", question), record, 1s);
    question = requester.Due(2s).at(0).What;
    EXPECT_GT(question.offset, 0U);
    Answer damaged = AnswerTo(question);
    damaged.result = Result::FAILED;
    damaged.size = PostAnswers::NeverReadable;
    requester.Answered("uav1", damaged, record, 2s);
    question = requester.Due(3s).at(0).What;
    EXPECT_EQ(question.offset, 0U);
    EXPECT_FALSE((Range{question.from, question.to}.Contains(1500)));
}

// Older posts come nevertheless.
TEST_F(RequesterTest, APartThatCanNeverBeReadIsLeftOutAndTold)
{
    const Question question = AskForPosts();
    Answer damaged = AnswerTo(question);
    damaged.result = Result::FAILED;
    damaged.size = PostAnswers::NeverReadable;
    damaged.from = 1700;
    EXPECT_FALSE(requester.Answered("uav1", damaged, record, 1s));
    const auto due = requester.Due(1s);
    ASSERT_EQ(due.size(), 1U);
    EXPECT_EQ((Range{due[0].What.from, due[0].What.to}), (Range{1000, 1700}));
    const auto whole = requester.Answered("uav1", WithPost(due[0].What, TimeOf(1500)), record, 2s);
    ASSERT_TRUE(whole);
    EXPECT_EQ(whole->second, (Range{1000, 1700}));
    EXPECT_EQ(requester.Refusals().at({"uav1", "Pose"}),
              "a part of its recording is damaged, or was removed");
    // The damaged file is removed in time.
    const auto spans = requester.Due(1s + Requester::LongestLook);
    Answer answer = AnswerTo(spans.at(0).What);
    answer.bytes = PostsCodec::EncodeSpans({{7, {2500, 3000}}});
    requester.Answered("uav1", answer, record, 62s);
    EXPECT_TRUE(requester.Refusals().empty());
}

// Else the loss would be told for a moment alone: the next spans begin behind it.
TEST_F(RequesterTest, APartThatWasRemovedIsToldForAMinute)
{
    const Question question = AskForPosts();
    Answer removed = AnswerTo(question);
    removed.result = Result::FAILED;
    removed.size = PostAnswers::NeverReadable;
    const auto at = Requester::LongestLook - 1s;
    EXPECT_FALSE(requester.Answered("uav1", removed, record, at));
    for (const auto now : {Requester::LongestLook, 2 * Requester::LongestLook})
    {
        EXPECT_EQ(requester.Refusals().count({"uav1", "Pose"}), 1U);
        const auto spans = requester.Due(now);
        ASSERT_EQ(spans.size(), 1U);
        ASSERT_EQ(spans[0].What.kind, Kind::SPANS);
        Answer answer = AnswerTo(spans[0].What);
        answer.bytes = PostsCodec::EncodeSpans({{7, {2000, 2000}}});
        requester.Answered("uav1", answer, record, now);
    }
    EXPECT_TRUE(requester.Refusals().empty());
}

TEST_F(RequesterTest, PostsThatANodeDoesNotRecordComeLiveAlone)
{
    const std::set<std::pair<std::string, std::string>> pose{{"uav1", "Pose"}};
    Answer answer = AnswerTo(requester.Due(0s).at(0).What);
    EXPECT_TRUE(requester.LiveOnly().empty()) << "not known yet";
    answer.result = Result::UNKNOWN;
    requester.Answered("uav1", answer, record, 0s);
    EXPECT_EQ(requester.LiveOnly(), pose);
    answer = AnswerTo(requester.Due(Requester::Pause).at(0).What);
    requester.Answered("uav1", answer, record, Requester::Pause);
    EXPECT_TRUE(requester.LiveOnly().empty());
}

// It may have been announced a moment later.
TEST_F(RequesterTest, PostsOfANodeThatRefusedAQuestionComeLater)
{
    const auto due = requester.Due(0s);
    requester.Failed("uav1", due.at(0).What, 0s);
    EXPECT_TRUE(requester.LiveOnly().empty());
    EXPECT_TRUE(requester.Due(1s).empty());
    EXPECT_EQ(requester.Due(Requester::Pause).size(), 1U) << "it is asked again";
}

TEST_F(RequesterTest, ANodeThatIsNotUpIsNotAskedAndNotGivenUp)
{
    const Question question = AskForPosts();
    requester.SetNode("uav1", 7, false, {"Pose"}, 1s);
    EXPECT_TRUE(requester.Due(1000s).empty());
    requester.SetNode("uav1", 7, true, {"Pose"}, 1000s);
    EXPECT_TRUE(requester.Due(1001s).empty()) << "the answer is still on its way";
    EXPECT_TRUE(requester.Answered("uav1", WithPost(question, TimeOf(1500)), record, 1002s));
}

TEST_F(RequesterTest, ARestartOfTheNodeIsAskedAgainAtOnce)
{
    AskForPosts();
    requester.SetNode("uav1", 8, true, {"Pose"}, 1s);
    EXPECT_EQ(requester.Due(1s).at(0).What.kind, Kind::SPANS);
}

TEST_F(RequesterTest, AfterAStartOverAnswersUnderWayAreDropped)
{
    const Question question = AskForPosts();
    ledger.Clear();
    requester.StartOver(1s);
    EXPECT_FALSE(requester.Answered("uav1", WithPost(question, TimeOf(1500)), record, 1s));
    EXPECT_EQ(requester.Due(1s).at(0).What.kind, Kind::SPANS);
}

TEST_F(RequesterTest, TheNodesTakeTurns)
{
    requester.SetNode("uav2", 1, true, {"Pose"}, 0s);
    const auto due = requester.Due(0s);
    ASSERT_EQ(due.size(), 1U);
    EXPECT_EQ(due[0].Node, "uav1");
    requester.Answered("uav1", AnswerTo(due[0].What), record, 0s);
    EXPECT_EQ(requester.Due(0s).at(0).Node, "uav2");
}

TEST_F(RequesterTest, ANodeThatDoesNotAnswerHoldsUpNoOther)
{
    requester.SetNode("uav2", 1, true, {"Pose"}, 0s);
    EXPECT_EQ(requester.Due(0s).at(0).Node, "uav1");
    EXPECT_TRUE(requester.Due(1s).empty());
    EXPECT_EQ(requester.Due(Requester::Slow).at(0).Node, "uav2");
}

TEST_F(RequesterTest, AfterAnAnswerTheChannelIsLeftToOthers)
{
    const Question question = AskForPosts();
    Answer answer = WithPost(question, TimeOf(1500));
    answer.from = 1500;  // there are more
    answer.bytes = PostsCodec::EncodePosts(
        {{TimeOf(1500), std::vector<std::uint8_t>(PostAnswers::LargestAnswer)}}, 1500);
    requester.Answered("uav1", answer, record, 2s);
    EXPECT_TRUE(requester.Due(2s + 2s * Requester::Rest - 1ms).empty());
    EXPECT_EQ(requester.Due(2s + 2s * Requester::Rest).at(0).What.to, 1500U);
}

TEST_F(RequesterTest, ARefusalHasAReason)
{
    Answer answer = AnswerTo(requester.Due(0s).at(0).What);
    answer.result = Result::NOT_ALLOWED;
    requester.Answered("uav1", answer, record, 0s);
    EXPECT_EQ(requester.Refusals().at({"uav1", "Pose"}),
              "it does not let this node have them (`backfill_to` there)");
    EXPECT_TRUE(requester.Due(1s).empty());
}

TEST_F(RequesterTest, TheNewestPostsAreLookedAtNowAndThen)
{
    requester.Answered("uav1", AnswerTo(AskForPosts()), record, 0s);
    ledger.Take({"uav1", "Pose", 7}, 3000);
    EXPECT_TRUE(requester.Due(1s).empty());
    const auto due = requester.Due(2 * Requester::ShortestLook);
    ASSERT_EQ(due.size(), 1U);
    EXPECT_EQ((Range{due[0].What.from, due[0].What.to}), (Range{2000, 3001}));
    EXPECT_EQ(PostsCodec::DecodeStamps(due[0].What.had, 2000), std::vector<Stamp>{3000});
}

}  // namespace
}  // namespace Rabit::Backfill
