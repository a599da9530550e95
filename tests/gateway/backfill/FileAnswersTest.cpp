#include "backfill/FileAnswers.h"

#include <gtest/gtest.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>

#include "../../NoDescriptors.h"

namespace Rabit::Backfill
{
namespace
{

class FileAnswersTest : public testing::Test
{
protected:
    FileAnswersTest()
    {
        std::string pattern = (std::filesystem::temp_directory_path() / "backfillXXXXXX").string();
        folder = ::mkdtemp(pattern.data());
        std::filesystem::create_directory(folder / "shown");
        std::ofstream(folder / "shown" / "a.txt") << "hello";
        std::ofstream(folder / "secret.txt") << "secret";
        shown = std::make_unique<FileAnswers>((folder / "shown").string(),
                                              [](const std::string &node) { return node == "ground"; });
    }
    ~FileAnswersTest() override { std::filesystem::remove_all(folder); }

    std::filesystem::path folder;
    std::unique_ptr<FileAnswers> shown;

    Answer Ask(const std::string &name, Kind kind = Kind::FACTS, std::uint64_t from = 0,
               std::uint64_t to = 100, const std::string &node = "ground")
    {
        Question question;
        question.kind = kind;
        question.name = name;
        question.from = from;
        question.to = to;
        question.number = 77;
        ++calls;
        std::optional<Answer> answer = shown->Of(node, question);
        for (int turn = 0; !answer && turn < 1000; ++turn)
        {
            ++calls;
            shown->BeginTurn();
            answer = shown->Of(node, question);
        }
        EXPECT_TRUE(answer) << name << " has no answer";
        return answer.value_or(Answer());
    }
    // Makes a file of that many zeros. Returns a question about it.
    Question Zeros(const std::string &name, std::uint64_t size)
    {
        std::ofstream(folder / "shown" / name) << std::string();
        std::filesystem::resize_file(folder / "shown" / name, size);
        Question question;
        question.kind = Kind::FACTS;
        question.name = name;
        return question;
    }

    int calls = 0;
};

TEST_F(FileAnswersTest, SizeAndHashAreTold)
{
    const Answer answer = Ask("a.txt");
    EXPECT_EQ(answer.result, Result::OK);
    EXPECT_EQ(answer.number, 77U);
    EXPECT_EQ(answer.size, 5U);
    ASSERT_EQ(answer.bytes.size(), 32U);
    EXPECT_EQ(answer.bytes[0], 0x2c) << "SHA-256 of hello";
    EXPECT_EQ(answer.bytes[31], 0x24);
}

TEST_F(FileAnswersTest, AChangedFileHasAnotherHash)
{
    const auto before = Ask("a.txt").bytes;
    std::ofstream(folder / "shown" / "a.txt", std::ios::app) << " world";
    EXPECT_NE(Ask("a.txt").bytes, before);
}

TEST_F(FileAnswersTest, ALargeFileIsHashedInPieces)
{
    const std::filesystem::path large = folder / "shown" / "large";
    std::ofstream(large) << "x";
    std::filesystem::resize_file(large, 2 * FileAnswers::HashedAtOnce + 1);
    const Answer facts = Ask("large");
    EXPECT_EQ(calls, 3);
    EXPECT_EQ(facts.size, 2 * FileAnswers::HashedAtOnce + 1);
    EXPECT_EQ(Ask("large").bytes, facts.bytes);
    EXPECT_EQ(calls, 4) << "the hash is remembered";
    const int file = ::open(large.c_str(), O_RDONLY);
    EXPECT_EQ(HashOf(file, facts.size), facts.bytes);
    ::close(file);
}

TEST_F(FileAnswersTest, AFileThatGrowsWhileItIsHashedIsToldAsItWas)
{
    const std::filesystem::path large = folder / "shown" / "large";
    std::ofstream(large) << "x";
    std::filesystem::resize_file(large, 2 * FileAnswers::HashedAtOnce);
    Question question;
    question.kind = Kind::FACTS;
    question.name = "large";
    EXPECT_FALSE(shown->Of("ground", question));
    std::filesystem::resize_file(large, 3 * FileAnswers::HashedAtOnce);
    shown->BeginTurn();
    const std::optional<Answer> answer = shown->Of("ground", question);
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->size, 2 * FileAnswers::HashedAtOnce);
    EXPECT_EQ(Ask("large").size, 3 * FileAnswers::HashedAtOnce);
}

TEST_F(FileAnswersTest, OneTurnHashesALimitedPartOfAllFilesTogether)
{
    const Question first = Zeros("first", FileAnswers::HashedAtOnce - 1);
    const Question second = Zeros("second", FileAnswers::HashedAtOnce);
    EXPECT_TRUE(shown->Of("ground", first));
    EXPECT_FALSE(shown->Of("ground", second));
    shown->BeginTurn();
    EXPECT_TRUE(shown->Of("ground", second));
}

TEST_F(FileAnswersTest, AFileThatIsReplacedWhileItIsHashedIsHashedAnew)
{
    const Question question = Zeros("large", 2 * FileAnswers::HashedAtOnce);
    EXPECT_FALSE(shown->Of("ground", question));
    Zeros("new", 2 * FileAnswers::HashedAtOnce);
    std::ofstream(folder / "shown" / "new", std::ios::in | std::ios::out) << "new";
    std::filesystem::rename(folder / "shown" / "new", folder / "shown" / "large");
    const Answer answer = Ask("large");
    const int file = ::open((folder / "shown" / "large").c_str(), O_RDONLY);
    EXPECT_EQ(HashOf(file, answer.size), answer.bytes);
    ::close(file);
}

TEST_F(FileAnswersTest, AFileThatIsCutOffWhileItIsHashedIsHashedAnew)
{
    const Question question = Zeros("large", 2 * FileAnswers::HashedAtOnce);
    EXPECT_FALSE(shown->Of("ground", question));
    std::filesystem::resize_file(folder / "shown" / "large", 5);
    EXPECT_EQ(Ask("large").size, 5U);
}

TEST_F(FileAnswersTest, ManyOtherFilesDoNotInterruptAHash)
{
    const Question question = Zeros("large", 2 * FileAnswers::HashedAtOnce);
    EXPECT_FALSE(shown->Of("ground", question));
    for (int other = 0; other < 100; ++other)
    {
        Zeros(std::to_string(other), 1);
        Ask(std::to_string(other));
    }
    shown->BeginTurn();
    EXPECT_TRUE(shown->Of("ground", question));
}

TEST_F(FileAnswersTest, ManyLargeFilesAreAllHashedInTheEnd)
{
    for (int name = 0; name < 100; ++name)
    {
        EXPECT_EQ(shown->Of("ground", Zeros(std::to_string(name), FileAnswers::HashedAtOnce)).has_value(),
                  name == 0);
    }
    for (int name = 1; name < 100; ++name)
    {
        EXPECT_EQ(Ask(std::to_string(name)).result, Result::OK);
    }
}

TEST_F(FileAnswersTest, PartsAreSentAsFarAsTheFileGoes)
{
    const Answer answer = Ask("a.txt", Kind::PART, 1, 100);
    EXPECT_EQ(answer.result, Result::OK);
    EXPECT_EQ(std::string(answer.bytes.begin(), answer.bytes.end()), "ello");
    EXPECT_EQ(answer.to, 5U);
    EXPECT_EQ(Ask("a.txt", Kind::PART, 6, 7).result, Result::FAILED);
    EXPECT_EQ(Ask("a.txt", Kind::PART, 3, 2).result, Result::FAILED);
}

TEST_F(FileAnswersTest, ALargeQuestionGetsABoundedAnswer)
{
    std::ofstream(folder / "shown" / "large") << std::string(1'000'000, 'x');
    EXPECT_EQ(Ask("large", Kind::PART, 0, ~std::uint64_t{0}).bytes.size(), FileAnswers::LargestPart);
}

TEST_F(FileAnswersTest, NoWayLeadsOutOfTheFolder)
{
    std::filesystem::create_symlink(folder / "secret.txt", folder / "shown" / "link");
    std::filesystem::create_directory(folder / "shown" / "below");
    ::mkfifo((folder / "shown" / "pipe").c_str(), 0600);
    for (const char *name : {"../secret.txt", "link", "below", "below/x", "pipe", ".", "..", "", "none"})
    {
        EXPECT_EQ(Ask(name).result, Result::UNKNOWN) << name;
        EXPECT_TRUE(Ask(name, Kind::PART).bytes.empty()) << name;
    }
    EXPECT_EQ(Ask((folder / "secret.txt").string()).result, Result::UNKNOWN);
    EXPECT_EQ(Ask(std::string("a.txt\0x", 7)).result, Result::UNKNOWN);
}

TEST_F(FileAnswersTest, OnlyNamedNodesMayFetch)
{
    EXPECT_EQ(Ask("a.txt", Kind::FACTS, 0, 0, "uav2").result, Result::NOT_ALLOWED);
    EXPECT_EQ(Ask("a.txt", Kind::PART, 0, 5, "uav2").result, Result::NOT_ALLOWED);
}

// Neither the folder, nor the file in it.
TEST_F(FileAnswersTest, AFileThatCannotBeOpenedNowIsNotSaidToBeMissing)
{
    for (const unsigned spare : {0U, 1U})
    {
        const NoDescriptors none(spare);
        EXPECT_EQ(Ask("a.txt").result, Result::FAILED);
        EXPECT_EQ(Ask("a.txt", Kind::PART).result, Result::FAILED);
    }
    EXPECT_EQ(Ask("a.txt").result, Result::OK);
}

TEST_F(FileAnswersTest, WithoutItsFolderThereIsNoFile)
{
    std::filesystem::remove_all(folder);
    EXPECT_EQ(Ask("a.txt").result, Result::UNKNOWN);
}

}  // namespace
}  // namespace Rabit::Backfill
