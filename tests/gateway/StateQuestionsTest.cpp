#include "presence/StateQuestions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using Ns = std::chrono::nanoseconds;

std::string Names(const std::vector<StateQuestions::Question> &questions)
{
    std::string names;
    for (const auto &question : questions)
    {
        names += question.Node;
    }
    return names;
}

TEST(StateQuestions, NamesStatesByBits)
{
    StateQuestions questions;
    std::vector<bool> states(20, false);
    states[0] = states[9] = true;
    questions.Set("a", states, false, 1s);
    EXPECT_THAT(questions.Take(8).at(0).States, ElementsAre(1, 2));
}

TEST(StateQuestions, AreAskedUntilTheyAreAnswered)
{
    StateQuestions questions;
    questions.Set("a", {true}, false, 1s);
    EXPECT_EQ(Names(questions.Take(8)), "a");
    EXPECT_EQ(Names(questions.Take(8)), "a");
    questions.Set("a", {false}, false, 2s);
    EXPECT_EQ(Names(questions.Take(8)), "");
}

TEST(StateQuestions, WhatIsNeededSoonDoesNotWaitUntilItWasAsked)
{
    StateQuestions questions;
    questions.Set("a", {true}, false, 1s);
    EXPECT_EQ(questions.DueSince(), std::nullopt);
    questions.Set("a", {true}, true, 2s);
    questions.Set("a", {true, true}, false, 3s);
    EXPECT_EQ(questions.DueSince(), Ns(2s));
    questions.Take(8);
    EXPECT_EQ(questions.DueSince(), std::nullopt);
}

TEST(StateQuestions, NodesTakeTurns)
{
    StateQuestions questions;
    for (const char *node : {"a", "b", "c"})
    {
        questions.Set(node, {true}, false, 1s);
    }
    EXPECT_EQ(Names(questions.Take(2)), "ab");
    EXPECT_EQ(Names(questions.Take(2)), "ca");
}

TEST(StateQuestions, WhatIsNeededSoonGoesFirst)
{
    StateQuestions questions;
    questions.Set("a", {true}, false, 1s);
    questions.Set("b", {true}, false, 1s);
    questions.Set("c", {true}, true, 2s);
    questions.Take(0);
    EXPECT_EQ(Names(questions.Take(2)), "ca");
}

}  // namespace
}  // namespace Rabit
