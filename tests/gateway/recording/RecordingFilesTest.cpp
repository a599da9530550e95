#include "recording/RecordingFiles.h"

#include <gmock/gmock.h>

#include "FakeDisk.h"

namespace Rabit
{
namespace
{

using testing::ElementsAre;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

constexpr std::uint64_t Start = 1763866000 * std::uint64_t{1000000000};
constexpr std::uint64_t Millisecond = 1000000;
constexpr std::uint64_t Mebibyte = 1U << 20;

class RecordingFilesTest : public testing::Test
{
protected:
    RecordingFilesTest()
    {
        _settings.Name = "uav1";
        _settings.Record.Folder = "/recordings";
        _settings.Record.Free = 100 * Mebibyte;
        _batch.NewStreams.push_back(std::make_shared<const RecordingStream>(
            RecordingStream{.Topic = "uav1/Pose", .SchemaName = "", .IsState = false}));
        _batch.NewStreams.push_back(std::make_shared<const RecordingStream>(
            RecordingStream{.Topic = "uav1/Health", .SchemaName = "", .IsState = true}));
    }

    // An earlier recording, and three files of this one, the last of which is being written.
    void RecordThreeFiles()
    {
        _disk.Capacity = 1000 * Mebibyte;
        _disk.Put("uav1_000001_20250101T000000Z.mcap", 6 * Mebibyte);
        _settings.Record.SplitSize = 2 * Mebibyte;
        for (int count = 0; count < 50; ++count)
        {
            Record(0, 100000);
        }
        ASSERT_THAT(_disk.Names(),
                    ElementsAre("uav1_000001_20250101T000000Z.mcap", SecondName, ThirdName, FourthName));
    }
    const std::string SecondName = "uav1_000002_20251123T024640Z.mcap";
    const std::string ThirdName = "uav1_000003_20251123T024640Z.mcap";
    const std::string FourthName = "uav1_000004_20251123T024640Z.mcap";

    RecordingFiles &Files()
    {
        if (!_files)
        {
            _files = std::make_unique<RecordingFiles>(_disk, _settings);
        }
        return *_files;
    }

    // Records one message now, and does the work that is due.
    void Record(std::uint32_t stream = 0, std::size_t bytes = 100)
    {
        _batch.Items.push_back({stream, 0, _now, _now - 5, Mcap::Bytes(bytes, 7)});
        TakeAndServe();
    }
    void TakeAndServe()
    {
        Files().Take(_batch, _now);
        Files().Service(_now);
        _batch = {};
    }
    void Pass(std::uint64_t milliseconds)
    {
        for (std::uint64_t passed = 0; passed < milliseconds; passed += 100)
        {
            _now += 100 * Millisecond;
            Files().Service(_now);
        }
    }

    FakeDisk _disk;
    RecordingSettings _settings;
    RecordingInbox::Batch _batch;
    std::uint64_t _now = Start;
    std::unique_ptr<RecordingFiles> _files;
};

TEST_F(RecordingFilesTest, WritesWhatItTakesIntoAFileWithNumberAndDate)
{
    _batch.Metadata.push_back({"rabit.configuration", {{"node", "uav1"}}});
    Record();
    Files().Close(_now);
    ASSERT_THAT(_disk.Names(), ElementsAre("uav1_000001_20251123T024640Z.mcap"));
    const MemoryFile file = _disk.Open(_disk.Names()[0]);
    EXPECT_THAT(LogTimesOf(file), ElementsAre(Start));
    EXPECT_EQ(MetadataOf(file, "rabit.configuration").at("node"), "uav1");
    EXPECT_EQ(MetadataOf(file, "rabit.file").at("number"), "1");
    EXPECT_EQ(Files().Status().Messages, 1U);
}

// Reads the file as it would be after a loss of power at any moment.
TEST_F(RecordingFilesTest, HasAllButTheLastSecondOnTheDisk)
{
    for (int turn = 0; turn < 100; ++turn)
    {
        Record(0, turn % 7 == 0 ? Mcap::McapWriter::LargeMessage : 100);
        const auto &content = *_disk.Files.begin()->second;
        const auto begin = content.Bytes.begin();
        const auto times =
            LogTimesOf(MemoryFile(Mcap::Bytes(begin, begin + static_cast<std::ptrdiff_t>(content.Synced))));
        const std::uint64_t newest = times.empty() ? 0 : times.back();
        ASSERT_LE(_now, std::max(newest, Start) + 500 * Millisecond) << "turn " << turn;
        _now += 100 * Millisecond;
    }
}

// Reads all files as they would be after a loss of power before any write, while some are split and removed.
TEST_F(RecordingFilesTest, HasAllButTheLastSecondOnTheDiskWhileFilesAreSplit)
{
    _settings.Record.SplitSize = 1 * Mebibyte;
    _settings.Record.Keep = 4 * Mebibyte;
    _settings.Compresses = false;
    std::size_t looks = 0;
    _disk.BeforeWrite = [&]
    {
        std::vector<std::uint64_t> times;
        for (const auto &[name, content] : _disk.Files)
        {
            const auto begin = content->Bytes.begin();
            const auto some = LogTimesOf(
                MemoryFile(Mcap::Bytes(begin, begin + static_cast<std::ptrdiff_t>(content->Synced))));
            times.insert(times.end(), some.begin(), some.end());
        }
        ASSERT_LE(_now, (times.empty() ? Start : times.back()) + 500 * Millisecond) << "look " << looks;
        for (std::size_t at = 1; at < times.size(); ++at)
        {
            ASSERT_EQ(times[at], times[at - 1] + 100 * Millisecond) << "look " << looks;
        }
        ++looks;
    };
    for (int turn = 0; turn < 100; ++turn)
    {
        Record(0, turn % 7 == 0 ? 200'000 : 100'000);
        _now += 100 * Millisecond;
    }
    EXPECT_GT(looks, 50U);
    EXPECT_GT(Files().Status().Files, 8U);
    EXPECT_LT(_disk.Files.size(), 8U);
}

TEST_F(RecordingFilesTest, BeginsAFileWhenOneIsLargeEnough)
{
    _settings.Record.SplitSize = 2 * Mebibyte;
    for (int count = 0; count < 50; ++count)
    {
        Record(0, 100000);
    }
    Files().Close(_now);
    EXPECT_EQ(_disk.Files.size(), 3U);
    std::size_t messages = 0;
    for (const std::string &name : _disk.Names())
    {
        messages += LogTimesOf(_disk.Open(name)).size();
        EXPECT_LT(_disk.Files[name]->Bytes.size(), 2 * Mebibyte + 200000);
    }
    EXPECT_EQ(messages, 50U);
}

TEST_F(RecordingFilesTest, BeginsAFileWhenOneIsLongEnoughAndRepeatsTheStates)
{
    _settings.Record.SplitTime = std::chrono::minutes(1);
    Record(1);
    Pass(61000);
    ASSERT_EQ(_disk.Files.size(), 1U);
    Record(0);
    Files().Close(_now);
    ASSERT_EQ(_disk.Files.size(), 2U);
    EXPECT_THAT(LogTimesOf(_disk.Open(_disk.Names()[0])), ElementsAre(Start));
    // The state and the message, both recorded now.
    EXPECT_THAT(LogTimesOf(_disk.Open(_disk.Names()[1])), ElementsAre(_now, _now));
    EXPECT_EQ(MetadataOf(_disk.Open(_disk.Names()[1]), "rabit.file").at("number"), "2");
    // Both files name the recording that they belong to.
    EXPECT_EQ(MetadataOf(_disk.Open(_disk.Names()[0]), "rabit.file").at("recording") + ".mcap",
              _disk.Names()[0]);
    EXPECT_EQ(MetadataOf(_disk.Open(_disk.Names()[1]), "rabit.file").at("recording") + ".mcap",
              _disk.Names()[0]);
}

// A post that was fetched from another node comes long after its time.
TEST_F(RecordingFilesTest, RepeatsNoStateBeforeItsTimeWhenAnOldMessageBeginsAFile)
{
    _settings.Record.SplitTime = std::chrono::minutes(1);
    Record(1);
    Pass(61000);
    _batch.Items.push_back({0, 0, Start - 1800000 * Millisecond, Start - 1800000 * Millisecond, {7}});
    TakeAndServe();
    Files().Close(_now);
    ASSERT_EQ(_disk.Files.size(), 2U);
    EXPECT_THAT(LogTimesOf(_disk.Open(_disk.Names()[1])),
                UnorderedElementsAre(Start - 1800000 * Millisecond, Start));
}

TEST_F(RecordingFilesTest, GoesOnBehindTheLastNumberThatIsThere)
{
    _disk.Put("uav1_000041_20250101T000000Z.mcap", 5);
    _disk.Put("uav2_000077_20250101T000000Z.mcap", 5);
    _disk.Put("uav1_x.mcap", 5);
    Record();
    Files().Close(_now);
    EXPECT_EQ(_disk.Files.count("uav1_000042_20251123T024640Z.mcap"), 1U);
}

TEST_F(RecordingFilesTest, RemovesItsOldestWhenTheyAreTooMuch)
{
    _settings.Record.Keep = 10 * Mebibyte;
    _disk.Put("uav1_000001_20250101T000000Z.mcap", 6 * Mebibyte);
    _disk.Put("uav1_000002_20240101T000000Z.mcap", 6 * Mebibyte);
    _disk.Put("uav2_000001_20230101T000000Z.mcap", 60 * Mebibyte);
    _disk.Put("uav1_000001_20250101T000000Z_recovered.mcap", 60 * Mebibyte);
    Record();
    EXPECT_EQ(_disk.Files.count("uav1_000001_20250101T000000Z.mcap"), 0U);
    EXPECT_EQ(_disk.Files.count("uav1_000002_20240101T000000Z.mcap"), 1U);
    EXPECT_EQ(_disk.Files.count("uav2_000001_20230101T000000Z.mcap"), 1U);
    EXPECT_EQ(_disk.Files.count("uav1_000001_20250101T000000Z_recovered.mcap"), 1U);
    EXPECT_THAT(
        Files().TakeRemovals(),
        ElementsAre("removed /recordings/uav1_000001_20250101T000000Z.mcap, the oldest file of uav1: its "
                    "files took more than the 10 MiB that are kept"));
}

TEST_F(RecordingFilesTest, RemovesNoEarlierRecordingToKeepTheMarginFree)
{
    _settings.RemovesOwnStart = true;
    _disk.Capacity = 1000 * Mebibyte;
    _disk.Put("uav1_000001_20250101T000000Z.mcap", 6 * Mebibyte);
    _disk.UsedByOthers = 899 * Mebibyte;
    Record();
    EXPECT_THAT(_disk.Names(), ElementsAre("uav1_000001_20250101T000000Z.mcap"));
    EXPECT_EQ(Files().Status().Problem,
              "only 95 MiB are free in /recordings, and 100 are to stay free; move earlier recordings away");
    EXPECT_THAT(Files().TakeRemovals(), IsEmpty());
}

TEST_F(RecordingFilesTest, RemovesItsOwnOldestToKeepTheMarginFree)
{
    _settings.RemovesOwnStart = true;
    RecordThreeFiles();
    _disk.UsedByOthers = 890 * Mebibyte;
    Pass(1500);
    EXPECT_THAT(_disk.Names(), ElementsAre("uav1_000001_20250101T000000Z.mcap", ThirdName, FourthName));
    EXPECT_EQ(Files().Status().Problem, "");
    EXPECT_THAT(Files().TakeRemovals(),
                ElementsAre("removed /recordings/" + SecondName +
                            ", the oldest file of this recording: less than 100 MiB were free"));
    EXPECT_THAT(Files().TakeRemovals(), IsEmpty()) << "each is told once";
}

TEST_F(RecordingFilesTest, PausesRatherThanRemoveItsLastFile)
{
    _settings.RemovesOwnStart = true;
    RecordThreeFiles();
    _disk.UsedByOthers = 999 * Mebibyte;
    Pass(1500);
    Record();
    Pass(1500);
    Record();
    EXPECT_THAT(_disk.Names(), ElementsAre("uav1_000001_20250101T000000Z.mcap", FourthName));
    EXPECT_NE(Files().Status().Problem, "");
}

// As the program `rabit` records.
TEST_F(RecordingFilesTest, RemovesNothingUnlessItIsToldTo)
{
    RecordThreeFiles();
    _disk.UsedByOthers = 999 * Mebibyte;
    Pass(1500);
    Record();
    EXPECT_EQ(_disk.Files.size(), 4U);
    EXPECT_NE(Files().Status().Problem, "");
}

TEST_F(RecordingFilesTest, StopsAtTheMarginAndGoesOnWhenThereIsRoomAgain)
{
    _disk.Capacity = 1000 * Mebibyte;
    Record(1);
    _disk.UsedByOthers = 950 * Mebibyte;
    Pass(1500);
    EXPECT_EQ(Files().Status().Problem,
              "only 49 MiB are free in /recordings, and 100 are to stay free; move earlier recordings away");
    EXPECT_TRUE(Files().Status().File.empty());
    Record();
    Record();
    EXPECT_EQ(Files().Status().Lost.at("uav1/Pose"), 2U);
    EXPECT_TRUE(Mcap::ReadContents(*std::make_unique<MemoryFile>(_disk.Open(_disk.Names()[0]))).IsIndexed);

    _disk.UsedByOthers = 0;
    Pass(1500);
    Record();
    EXPECT_EQ(Files().Status().Problem, "");
    Files().Close(_now);
    ASSERT_EQ(_disk.Files.size(), 2U);
    EXPECT_EQ(MetadataOf(_disk.Open(_disk.Names()[1]), "rabit.losses").at("uav1/Pose"), "2");
    EXPECT_EQ(LogTimesOf(_disk.Open(_disk.Names()[1])).size(), 2U) << "the state once more, and a message";
}

TEST_F(RecordingFilesTest, CountsWhatADiskThatFailsHasNotKept)
{
    Record();
    Pass(500);
    Record();
    Record(1);
    _disk.WriteFails = true;
    Pass(500);
    EXPECT_EQ(Files().Status().Lost.at("uav1/Pose"), 1U);
    EXPECT_EQ(Files().Status().Lost.at("uav1/Health"), 1U);
    EXPECT_EQ(Files().Status().Messages, 1U);
    EXPECT_EQ(Files().Status().Problem, "the disk takes no more");
    EXPECT_EQ(LogTimesOf(_disk.Open(_disk.Names()[0])).size(), 1U);

    _disk.WriteFails = false;
    Record();
    EXPECT_EQ(Files().Status().Lost.at("uav1/Pose"), 2U) << "nothing is tried for a second";
    Pass(1100);
    Record();
    Files().Close(_now);
    EXPECT_EQ(_disk.Files.size(), 2U);
    EXPECT_EQ(MetadataOf(_disk.Open(_disk.Names()[1]), "rabit.losses").at("uav1/Pose"), "2");
}

// Its problem may be over when the status is looked at.
TEST_F(RecordingFilesTest, KnowsThatMessagesWereNotKeptWhenTheDiskWorksAgain)
{
    Record();
    _disk.WriteFails = true;
    Pass(500);
    _disk.WriteFails = false;
    Pass(1100);
    Record();
    EXPECT_EQ(Files().Status().Problem, "");
    EXPECT_EQ(Files().Status().NotKept, 1U);
}

TEST_F(RecordingFilesTest, MessagesThatDidNotFitTheMemoryAreNotAFailureOfTheDisk)
{
    _batch.Lost = {3, 0};
    Record();
    EXPECT_EQ(Files().Status().NotKept, 0U);
}

TEST_F(RecordingFilesTest, AFileThatCannotBeEndedIsAProblem)
{
    Record();
    _disk.WriteFails = true;
    Files().Close(_now);
    EXPECT_EQ(Files().Status().Problem, "the disk takes no more");
    EXPECT_EQ(Files().Status().NotKept, 1U);
}

TEST_F(RecordingFilesTest, CountsWhatWasLostBeforeItCame)
{
    _batch.Lost = {3, 0};
    Record();
    Pass(1100);
    EXPECT_EQ(MetadataOf(_disk.Open(_disk.Names()[0]), "rabit.losses").at("uav1/Pose"), "3");
    EXPECT_EQ(MetadataOf(_disk.Open(_disk.Names()[0]), "rabit.losses").size(), 1U);
}

TEST_F(RecordingFilesTest, SaysWhyNoFileCanBeMade)
{
    _disk.CreateFails = "/recordings/x: Permission denied";
    Record();
    EXPECT_EQ(Files().Status().Problem, "/recordings/x: Permission denied");
    EXPECT_EQ(Files().Status().Lost.at("uav1/Pose"), 1U);
}

}  // namespace
}  // namespace Rabit
