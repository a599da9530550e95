#include "backfill/FileFetch.h"

#include <gtest/gtest.h>

#include <deque>
#include <memory>
#include <random>
#include <utility>

namespace Rabit::Backfill
{
namespace
{

using namespace std::chrono_literals;

std::vector<std::uint8_t> Content(std::size_t size)
{
    std::mt19937 random(7);
    std::vector<std::uint8_t> bytes(size);
    for (std::uint8_t &byte : bytes)
    {
        byte = static_cast<std::uint8_t>(random());
    }
    return bytes;
}

// Answers as the node of the file does.
Answer AnswerOf(const std::vector<std::uint8_t> &file, const Question &question)
{
    Answer answer;
    answer.kind = question.kind;
    answer.number = question.number;
    answer.name = question.name;
    answer.from = question.from;
    answer.size = file.size();
    if (question.kind == Kind::PART)
    {
        answer.bytes.assign(file.begin() + static_cast<std::ptrdiff_t>(question.from),
                            file.begin() + static_cast<std::ptrdiff_t>(question.to));
        answer.to = question.to;
    }
    else
    {
        answer.bytes = {1, 2, 3};
    }
    return answer;
}

TEST(FileFetchTest, FactsComeFirstAndThenSomePartsAhead)
{
    FileFetch fetch("a.mcap", 0, 1);
    fetch.SetNode(1, true, 0s);
    const auto facts = fetch.Due(0s);
    ASSERT_EQ(facts.size(), 1U);
    EXPECT_EQ(facts[0].kind, Kind::FACTS);
    const auto file = Content(10 * FileFetch::PartSize + 1);
    fetch.Answered(AnswerOf(file, facts[0]), 0s);
    const auto parts = fetch.Due(0s);
    ASSERT_EQ(parts.size(), FileFetch::MostAhead);
    EXPECT_EQ(parts[1].from, FileFetch::PartSize);
    EXPECT_TRUE(fetch.Due(1s).empty());
}

TEST(FileFetchTest, AFileThatIsHereInPartIsResumed)
{
    const auto file = Content(3 * FileFetch::PartSize);
    FileFetch fetch("a.mcap", 1000, 1);
    fetch.SetNode(1, true, 0s);
    fetch.Answered(AnswerOf(file, fetch.Due(0s)[0]), 0s);
    EXPECT_EQ(fetch.Due(0s)[0].from, 1000U);
}

TEST(FileFetchTest, AnEmptyFileIsWholeAtOnce)
{
    FileFetch fetch("a.mcap", 0, 1);
    fetch.SetNode(1, true, 0s);
    fetch.Answered(AnswerOf({}, fetch.Due(0s)[0]), 0s);
    EXPECT_TRUE(fetch.IsWhole());
    EXPECT_TRUE(fetch.Due(0s).empty());
}

TEST(FileFetchTest, AFileThatBecameShorterIsFetchedFromItsBeginning)
{
    FileFetch fetch("a.mcap", 5000, 1);
    fetch.SetNode(1, true, 0s);
    fetch.Answered(AnswerOf(Content(100), fetch.Due(0s)[0]), 0s);
    EXPECT_EQ(fetch.Have(), 0U);
}

// While it was fetched, exactly at what is here, or before it.
TEST(FileFetchTest, AfterAFileWasCutOffTheNodeIsAskedAnewWhatItHas)
{
    for (const std::size_t left : {FileFetch::PartSize, FileFetch::PartSize - 1})
    {
        const auto file = Content(3 * FileFetch::PartSize);
        FileFetch fetch("a.mcap", 0, 1);
        fetch.SetNode(1, true, 0s);
        fetch.Answered(AnswerOf(file, fetch.Due(0s)[0]), 0s);
        const auto parts = fetch.Due(0s);
        fetch.Answered(AnswerOf(file, parts[0]), 0s);
        Answer cutOff = AnswerOf(file, parts[1]);
        cutOff.result = left == FileFetch::PartSize ? Result::OK : Result::FAILED;
        cutOff.size = left;
        cutOff.bytes.clear();
        fetch.Answered(cutOff, 0s);
        EXPECT_EQ(fetch.Refusal(), "");
        const auto facts = fetch.Due(FileFetch::Pause);
        ASSERT_EQ(facts.size(), 1U);
        EXPECT_EQ(facts[0].kind, Kind::FACTS);
        fetch.Answered(AnswerOf(Content(left), facts[0]), FileFetch::Pause);
        EXPECT_EQ(fetch.IsWhole(), left == FileFetch::PartSize);
        EXPECT_EQ(fetch.Have(), left == FileFetch::PartSize ? left : 0U);
    }
}

TEST(FileFetchTest, ARefusalHasAReason)
{
    FileFetch fetch("a.mcap", 0, 1);
    fetch.SetNode(1, true, 0s);
    Answer answer = AnswerOf({}, fetch.Due(0s)[0]);
    answer.result = Result::UNKNOWN;
    fetch.Answered(answer, 0s);
    EXPECT_EQ(fetch.Refusal(), "it has no such file in its folder (`fetch: folder:`)");
}

TEST(FileFetchTest, BytesThatAreNotTheNextOnesAreDropped)
{
    const auto file = Content(3 * FileFetch::PartSize);
    FileFetch fetch("a.mcap", 0, 1);
    fetch.SetNode(1, true, 0s);
    fetch.Answered(AnswerOf(file, fetch.Due(0s)[0]), 0s);
    const auto parts = fetch.Due(0s);
    EXPECT_TRUE(fetch.Answered(AnswerOf(file, parts[1]), 0s).empty());
    EXPECT_EQ(fetch.Repeated(), FileFetch::PartSize);
    EXPECT_EQ(fetch.Answered(AnswerOf(file, parts[0]), 0s).size(), FileFetch::PartSize);
}

// Without this all later parts travel in vain, until the last one has come.
TEST(FileFetchTest, AfterALostAnswerItsPartIsAskedForAtOnce)
{
    FileFetch fetch("a.mcap", 0, 1);
    fetch.SetNode(1, true, 0s);
    const auto file = Content(100 * FileFetch::PartSize);
    fetch.Answered(AnswerOf(file, fetch.Due(0s)[0]), 0s);
    std::deque<Question> underWay;
    bool isLost = false;
    std::size_t answers = 0;
    while (!fetch.IsWhole())
    {
        for (Question &question : fetch.Due(0s))
        {
            underWay.push_back(std::move(question));
        }
        ASSERT_FALSE(underWay.empty()) << "nothing is asked for at byte " << fetch.Have();
        const Question question = underWay.front();
        underWay.pop_front();
        ++answers;
        if (question.from == 10 * FileFetch::PartSize && !std::exchange(isLost, true))
        {
            continue;
        }
        fetch.Answered(AnswerOf(file, question), 0s);
    }
    EXPECT_TRUE(isLost);
    EXPECT_LE(answers, 100 + FileFetch::MostAhead);
}

// The node and this program are killed now and then: what was under way is lost or arrives.
TEST(FileFetchTest, TheFileIsWholeWhateverIsKilled)
{
    const auto file = Content(1'000'000);
    for (unsigned seed = 1; seed <= 50; ++seed)
    {
        std::mt19937 random(seed);
        std::vector<std::uint8_t> here;
        auto fetch = std::make_unique<FileFetch>("a.mcap", 0, random());
        std::deque<Answer> underWay;
        std::uint64_t incarnation = 1;
        std::uint64_t repeated = 0;
        std::uint64_t kills = 0;
        std::chrono::nanoseconds now{0};
        for (; !fetch->IsWhole(); now += 100ms)
        {
            ASSERT_LT(now, 1000s) << seed;
            if (random() % 50 == 0)
            {
                ++kills;
                incarnation += random() % 2;
                repeated += fetch->Repeated();
                fetch = std::make_unique<FileFetch>("a.mcap", here.size(), random());
                if (random() % 2 == 0)
                {
                    underWay.clear();
                }
            }
            fetch->SetNode(incarnation, true, now);
            for (const Question &question : fetch->Due(now))
            {
                underWay.push_back(AnswerOf(file, question));
            }
            if (!underWay.empty())
            {
                const auto bytes = fetch->Answered(underWay.front(), now);
                here.insert(here.end(), bytes.begin(), bytes.end());
                underWay.pop_front();
            }
        }
        EXPECT_EQ(here, file) << seed;
        EXPECT_LE(repeated, kills * FileFetch::MostAhead * FileFetch::PartSize) << seed;
    }
}

}  // namespace
}  // namespace Rabit::Backfill
