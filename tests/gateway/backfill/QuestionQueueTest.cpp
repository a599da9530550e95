#include "backfill/QuestionQueue.h"

#include <gtest/gtest.h>

#include <vector>

namespace Rabit::Backfill
{
namespace
{

using namespace std::chrono_literals;
using Outcome = QuestionQueue::Outcome;

Question Numbered(std::uint64_t number)
{
    Question question;
    question.number = number;
    return question;
}

class QuestionQueueTest : public testing::Test
{
protected:
    // Returns the numbers of the questions that are answered now.
    std::vector<std::uint64_t> Answer(QuestionQueue::Duration now, Outcome outcome)
    {
        std::vector<std::uint64_t> numbers;
        queue.Answer(now,
                     [&numbers, outcome](const std::string &, const Question &question)
                     {
                         numbers.push_back(question.number);
                         return outcome;
                     });
        return numbers;
    }

    QuestionQueue queue;
};

TEST_F(QuestionQueueTest, QuestionsAreAnsweredOnceInTheirOrder)
{
    queue.Add("ground", Numbered(1));
    queue.Add("ground", Numbered(2));
    EXPECT_EQ(Answer(0s, Outcome::Answered), (std::vector<std::uint64_t>{1, 2}));
    EXPECT_TRUE(Answer(1s, Outcome::Answered).empty());
}

TEST_F(QuestionQueueTest, AQuestionWhoseAnswerWasRefusedIsAnsweredAgainAfterAPause)
{
    queue.Add("ground", Numbered(1));
    Answer(0s, Outcome::Refused);
    EXPECT_TRUE(Answer(QuestionQueue::Pause - 1ms, Outcome::Answered).empty());
    EXPECT_EQ(Answer(QuestionQueue::Pause, Outcome::Answered), (std::vector<std::uint64_t>{1}));
}

TEST_F(QuestionQueueTest, AQuestionWhoseAnswersAreRefusedIsDroppedInTheEnd)
{
    queue.Add("ground", Numbered(1));
    for (QuestionQueue::Duration now{0}; now <= QuestionQueue::Patience; now += QuestionQueue::Pause)
    {
        EXPECT_EQ(queue.Size(), 1U);
        Answer(now, Outcome::Refused);
    }
    EXPECT_EQ(queue.Size(), 0U);
}

TEST_F(QuestionQueueTest, AQuestionOfABusyNodeWaits)
{
    queue.Add("ground", Numbered(1));
    Answer(0s, Outcome::Later);
    EXPECT_EQ(Answer(1h, Outcome::Answered), (std::vector<std::uint64_t>{1}));
}

TEST_F(QuestionQueueTest, OneNodeDoesNotTakeThePlacesOfTheOthers)
{
    for (std::uint64_t number = 0; number < QuestionQueue::Most; ++number)
    {
        queue.Add("ground", Numbered(number));
    }
    EXPECT_EQ(queue.Size(), QuestionQueue::MostOfANode);
    EXPECT_TRUE(queue.Add("uav2", Numbered(1)));
}

}  // namespace
}  // namespace Rabit::Backfill
