// "Nothing" is not "complete": what an answer says of posts that are not written yet.
#include "backfill/PostAnswers.h"

#include <gtest/gtest.h>

#include <optional>

namespace Rabit::Backfill
{
namespace
{

class Store final : public PostStore
{
public:
    std::optional<std::vector<PostsCodec::Span>> Spans(const std::string &, std::uint64_t) override
    {
        return CanLook ? std::optional(Known) : std::nullopt;
    }
    Found Read(const std::string &, std::uint64_t, Range range, const std::vector<Stamp> &,
               std::size_t) override
    {
        return {.First = range.First, .Posts = {}, .Is = Is};
    }
    std::uint64_t Present() const override { return PresentIncarnation; }

    bool CanLook = true;
    std::vector<PostsCodec::Span> Known;
    std::uint64_t PresentIncarnation = 8;
    Found::Result Is = Found::Result::Readable;
};

class PostAnswersTest : public testing::Test
{
protected:
    Answer Ask(std::uint64_t incarnation)
    {
        Question question;
        question.kind = Kind::POSTS;
        question.name = "Pose";
        question.incarnation = incarnation;
        question.from = 100;
        question.to = 200;
        return answers.Of("ground", question);
    }

    Store store;
    PostAnswers answers{store, [](const std::string &, const std::string &) { return true; },
                        [](const std::string &) { return true; }};
};

// It was told once, else nobody would ask for it.
TEST_F(PostAnswersTest, AnIncarnationWhoseFilesWereRemovedIsNotWhole)
{
    const Answer answer = Ask(7);
    EXPECT_EQ(answer.result, Result::FAILED);
    EXPECT_EQ(answer.size, PostAnswers::NeverReadable);
    EXPECT_EQ(answer.from, 100U);
    EXPECT_EQ(answer.to, 200U);
}

TEST_F(PostAnswersTest, PostsInFilesThatWereRemovedAreNotWhole)
{
    for (const std::uint64_t incarnation : {7U, 8U})
    {
        store.Known = {{7, {200, 300}, true}, {8, {200, 300}, false}};
        const Answer answer = Ask(incarnation);
        EXPECT_EQ(answer.result, Result::FAILED);
        EXPECT_EQ(answer.size, PostAnswers::NeverReadable);
        EXPECT_EQ(answer.from, 100U);
        EXPECT_EQ(answer.to, 200U);
    }
}

TEST_F(PostAnswersTest, BehindFilesThatWereRemovedTheRestIsWhole)
{
    store.Known = {{7, {150, 300}, true}};
    const Answer answer = Ask(7);
    EXPECT_EQ(answer.result, Result::OK);
    EXPECT_EQ(answer.from, 150U);
    EXPECT_EQ(answer.to, 200U);
}

TEST_F(PostAnswersTest, WhileTheRecordingsCannotBeLookedAtNothingIsSaid)
{
    store.CanLook = false;
    for (const std::uint64_t incarnation : {7U, 8U})
    {
        EXPECT_EQ(Ask(incarnation).result, Result::FAILED);
        EXPECT_EQ(Ask(incarnation).size, 0U) << "it is to be asked again";
    }
    Question spans;
    spans.kind = Kind::SPANS;
    spans.name = "Pose";
    EXPECT_EQ(answers.Of("ground", spans).result, Result::FAILED);
    store.CanLook = true;
    EXPECT_EQ(answers.Of("ground", spans).result, Result::OK);
}

TEST_F(PostAnswersTest, OfThePresentIncarnationNothingIsWholeBeforeItsFirstPostIsWritten)
{
    const Answer answer = Ask(8);
    EXPECT_EQ(answer.result, Result::OK);
    EXPECT_EQ(answer.from, answer.to);
}

TEST_F(PostAnswersTest, ThePresentIncarnationIsWholeAsFarAsItIsWritten)
{
    store.Known = {{8, {50, 150}, false}};
    const Answer answer = Ask(8);
    EXPECT_EQ(answer.from, 100U);
    EXPECT_EQ(answer.to, 150U);
}

TEST_F(PostAnswersTest, BeforeThePresentIncarnationIsKnownNothingIsSaid)
{
    store.Known = {{8, {50, 150}, true}};
    store.PresentIncarnation = 0;
    EXPECT_EQ(Ask(8).result, Result::FAILED);
    EXPECT_EQ(Ask(8).size, 0U) << "it is to be asked again";
}

TEST_F(PostAnswersTest, ADamagedPartIsSaidToBeUnreadableForGood)
{
    store.Known = {{7, {50, 250}, true}};
    store.Is = PostStore::Found::Result::Damaged;
    const Answer answer = Ask(7);
    EXPECT_EQ(answer.result, Result::FAILED);
    EXPECT_EQ(answer.size, PostAnswers::NeverReadable);
    EXPECT_EQ(answer.from, 100U);
    EXPECT_EQ(answer.to, 200U);
}

TEST_F(PostAnswersTest, WhatCannotBeReadNowIsToBeAskedForAgain)
{
    store.Known = {{7, {50, 250}, true}};
    store.Is = PostStore::Found::Result::NotNow;
    const Answer answer = Ask(7);
    EXPECT_EQ(answer.result, Result::FAILED);
    EXPECT_EQ(answer.size, 0U);
}

}  // namespace
}  // namespace Rabit::Backfill
