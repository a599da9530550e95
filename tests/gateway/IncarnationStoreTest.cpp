#include "incarnation/IncarnationStore.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

namespace Rabit::Test
{
namespace
{

std::int64_t Nanoseconds(std::int64_t seconds)
{
    return seconds * 1'000'000'000;
}

class IncarnationStoreFile : public testing::Test
{
protected:
    IncarnationStoreFile()
        : _directory(std::filesystem::temp_directory_path() /
                     ("rabit_incarnation_" + std::to_string(::getpid()) + "_" +
                      testing::UnitTest::GetInstance()->current_test_info()->name()))
    {
        std::filesystem::remove_all(_directory);
    }
    ~IncarnationStoreFile() override { std::filesystem::remove_all(_directory); }

    // Starts the process at this reading of the wall clock, in seconds.
    IncarnationStore Start(std::int64_t seconds) const
    {
        return IncarnationStore(_directory, "uav1", [seconds] { return Nanoseconds(seconds); });
    }
    // Starts the process, saves, and returns its incarnation.
    std::uint64_t Live(std::int64_t seconds) const
    {
        IncarnationStore store = Start(seconds);
        const std::uint64_t incarnation = store.Above(0);
        store.Save();
        return incarnation;
    }
    void WriteFile(const std::string &text) const
    {
        std::filesystem::create_directories(_directory);
        std::ofstream(_directory / "uav1.incarnation") << text;
    }
    std::string ReadFile() const
    {
        std::ifstream in(_directory / "uav1.incarnation");
        std::ostringstream text;
        text << in.rdbuf();
        return text.str();
    }

    std::filesystem::path _directory;
};

std::uint64_t CounterOf(std::uint64_t incarnation)
{
    return incarnation >> 32;
}

TEST_F(IncarnationStoreFile, RisesAtEveryStartEvenWithinASecondAndWhenTheClockStepsBack)
{
    EXPECT_EQ(CounterOf(Live(1000)), 1000U);
    EXPECT_EQ(CounterOf(Live(1000)), 1001U);
    EXPECT_EQ(CounterOf(Live(5)), 1002U);
    EXPECT_EQ(CounterOf(Live(2000)), 2000U);
}

TEST_F(IncarnationStoreFile, IsStoredWhenSaveReturnsAndNotBefore)
{
    IncarnationStore store = Start(1000);
    store.Above(0);
    EXPECT_FALSE(std::filesystem::exists(_directory / "uav1.incarnation"));
    store.Save();
    EXPECT_EQ(ReadFile(), "1000\n");
    store.Above(5000ULL << 32);
    EXPECT_EQ(ReadFile(), "1000\n") << "no file is written by who holds a lock";
    store.Save();
    EXPECT_EQ(ReadFile(), "5001\n");
    EXPECT_EQ(store.Error(), "");
}

TEST_F(IncarnationStoreFile, RisesAboveAFloorAndAboveItself)
{
    IncarnationStore store = Start(1000);
    const std::uint64_t first = store.Above(0);
    const std::uint64_t second = store.Above(first);
    EXPECT_GT(CounterOf(second), CounterOf(first));
    EXPECT_GT(CounterOf(store.Above(0)), CounterOf(second));
    EXPECT_EQ(CounterOf(store.Above((7000ULL << 32) | 0xffffffff)), 7001U);
}

TEST_F(IncarnationStoreFile, IsMadeFromTheWallClockWhenTheFileIsLost)
{
    Live(1000);
    std::filesystem::remove_all(_directory);
    EXPECT_EQ(CounterOf(Live(1300)), 1300U);
}

TEST_F(IncarnationStoreFile, TellsOfAnUnusableFileAndReplacesIt)
{
    for (const char *text : {"rubbish\n", "", "12x\n", "-3\n", "99999999999999\n"})
    {
        WriteFile(text);
        IncarnationStore store = Start(1000);
        EXPECT_EQ(CounterOf(store.Above(0)), 1000U) << text;
        store.Save();
        EXPECT_NE(store.Error(), "") << text;
        EXPECT_EQ(ReadFile(), "1000\n") << text;
        store.Above(0);
        store.Save();
        EXPECT_EQ(store.Error(), "") << "all is well again";
    }
}

TEST_F(IncarnationStoreFile, TellsOfADirectoryThatCannotBeMade)
{
    WriteFile("1\n");
    const std::filesystem::path notADirectory = _directory / "uav1.incarnation" / "state";
    IncarnationStore store(notADirectory, "uav1", [] { return Nanoseconds(1000); });
    EXPECT_EQ(CounterOf(store.Above(0)), 1000U);
    store.Save();
    EXPECT_NE(store.Error().find("uav1.incarnation/state"), std::string::npos) << store.Error();
    EXPECT_EQ(CounterOf(store.Above(0)), 1001U) << "within one process it rises all the same";
}

TEST_F(IncarnationStoreFile, NeedsNoFile)
{
    IncarnationStore store("", "uav1", [] { return Nanoseconds(1000); });
    EXPECT_EQ(CounterOf(store.Above(0)), 1000U);
    EXPECT_EQ(store.Error(), "");
    EXPECT_TRUE(store.File().empty());
}

TEST_F(IncarnationStoreFile, HasRandomLowBits)
{
    const std::uint64_t first = IncarnationStore("", "uav1", [] { return Nanoseconds(1000); }).Above(0);
    bool differs = false;
    for (int i = 0; i < 10 && !differs; ++i)
    {
        differs = IncarnationStore("", "uav1", [] { return Nanoseconds(1000); }).Above(0) != first;
    }
    EXPECT_TRUE(differs);
}

TEST_F(IncarnationStoreFile, RisesWithinASecondWithoutAFile)
{
    constexpr std::int64_t Start = 1'700'000'000'000'000'000;
    constexpr std::int64_t Step = 20'000'000;  // faster than any process restarts
    std::uint64_t last = 0;
    for (std::int64_t now = Start; now < Start + Nanoseconds(2); now += Step)
    {
        const std::uint64_t incarnation = IncarnationStore("", "uav1", [now] { return now; }).Above(0);
        EXPECT_GT(incarnation, last) << now;
        EXPECT_EQ(CounterOf(incarnation), static_cast<std::uint64_t>(now / Nanoseconds(1)));
        last = incarnation;
    }
}

TEST_F(IncarnationStoreFile, NeverGivesOutTheHighestCounter)
{
    IncarnationStore store = Start(1000);
    EXPECT_EQ(CounterOf(store.Above(0xfffffffdULL << 32)), 0xfffffffeU);
    EXPECT_EQ(CounterOf(store.Above(0)), 0xfffffffeU);
}

TEST_F(IncarnationStoreFile, DoesNotBelieveAClockThatWouldUseUpTheCounter)
{
    EXPECT_EQ(CounterOf(Live(1000)), 1000U);
    EXPECT_EQ(CounterOf(Live(0xf0000000LL)), 1001U);
    EXPECT_EQ(CounterOf(Live(1LL << 33)), 1002U);
}

TEST_F(IncarnationStoreFile, ANodeNameCannotLeaveTheDirectory)
{
    const IncarnationStore store(_directory, "../u v1", [] { return 1; });
    EXPECT_EQ(store.File(), _directory / "..%2fu%20v1.incarnation");
}

TEST_F(IncarnationStoreFile, TheRealWallClockIsUsedByDefault)
{
    EXPECT_GT(CounterOf(IncarnationStore("", "uav1").Above(0)), 1600000000U);
}

}  // namespace
}  // namespace Rabit::Test
