#include <gmock/gmock.h>
#include <sys/stat.h>

#include <algorithm>

#include "FleetFolder.h"

namespace Rabit::Keys
{
namespace
{

namespace fs = std::filesystem;
using testing::HasSubstr;

class KeyFilesTest : public FleetFolder
{
};

TEST_F(KeyFilesTest, ASecretIsForItsOwnerAloneWhateverTheMaskSays)
{
    const mode_t before = ::umask(0);
    WriteSecret(Root + "/secret", "text");
    ::umask(before);
    EXPECT_EQ(fs::status(Root + "/secret").permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

TEST_F(KeyFilesTest, ASecretInPlaceOfAFileForAllIsForItsOwnerAlone)
{
    WriteFile(Root + "/secret", "old");
    WriteSecret(Root + "/secret", "new");
    EXPECT_EQ(ReadSecret(Root + "/secret"), "new");
}

TEST_F(KeyFilesTest, ASecretIsNotWrittenThroughALink)
{
    fs::create_symlink(Root + "/elsewhere", Root + "/secret.new");
    WriteSecret(Root + "/secret", "text");
    EXPECT_FALSE(fs::exists(Root + "/elsewhere"));
}

TEST_F(KeyFilesTest, ANewSecretDoesNotReplaceAnother)
{
    EXPECT_TRUE(WriteNewSecret(Root + "/secret", "first"));
    EXPECT_FALSE(WriteNewSecret(Root + "/secret", "second"));
    EXPECT_EQ(ReadSecret(Root + "/secret"), "first");
    const fs::directory_iterator files(Root);
    EXPECT_EQ(
        std::count_if(begin(files), end(files), [](const auto &entry) { return entry.is_regular_file(); }),
        1);
}

TEST_F(KeyFilesTest, ASecretThatOthersMayReadIsRefused)
{
    WriteFile(Root + "/secret", "text");
    EXPECT_THAT(WhyNot([&] { ReadSecret(Root + "/secret"); }), HasSubstr("(mode 644)"));
}

TEST_F(KeyFilesTest, AFolderAndAHugeFileAreNoKeys)
{
    EXPECT_THAT(WhyNot([&] { ReadFile(Root); }), HasSubstr("is no file"));
    std::ofstream(Root + "/huge") << std::string(2 << 20, 'x');
    EXPECT_THAT(WhyNot([&] { ReadFile(Root + "/huge"); }), HasSubstr("larger than 1 MiB"));
}

TEST_F(KeyFilesTest, AFifoIsNoKey)
{
    ASSERT_EQ(::mkfifo((Root + "/fifo").c_str(), 0600), 0);
    EXPECT_THAT(WhyNot([&] { ReadFile(Root + "/fifo"); }), HasSubstr("is no file"));
}

TEST_F(KeyFilesTest, AFileThatCannotBeWrittenLeavesNothingBehind)
{
    fs::create_directory(Root + "/folder");
    EXPECT_THAT(WhyNot([&] { WriteFile(Root + "/folder", "text"); }), HasSubstr("cannot write"));
    EXPECT_FALSE(fs::exists(Root + "/folder.new"));
}

}  // namespace
}  // namespace Rabit::Keys
