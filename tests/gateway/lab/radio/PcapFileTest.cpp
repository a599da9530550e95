#include "PcapFile.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <random>
#include <stdexcept>

namespace Rabit::Radio
{
namespace
{

using namespace std::chrono_literals;

std::uint32_t WordAt(const std::vector<char> &bytes, std::size_t at)
{
    std::uint32_t word = 0;
    std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(at), sizeof(word),
                reinterpret_cast<char *>(&word));
    return word;
}

TEST(PcapFileTest, AFrameFollowsItsTimeAndTwiceItsLength)
{
    const std::string path = std::filesystem::temp_directory_path() /
                             ("rabit-pcap-test-" + std::to_string(std::random_device{}()));
    {
        PcapFile file(path, 100s);
        EXPECT_TRUE(file.Write(1500ms, Frame{1, 2, 3}));
        EXPECT_TRUE(file.Write(2s, Frame(20)));
    }
    std::ifstream in(path, std::ios::binary);
    const std::vector<char> bytes{std::istreambuf_iterator<char>(in), {}};
    std::filesystem::remove(path);
    ASSERT_EQ(bytes.size(), 24u + 16 + 3 + 16 + 20);
    EXPECT_EQ(WordAt(bytes, 0), 0xa1b23c4d);
    EXPECT_EQ(WordAt(bytes, 20), 1u);
    EXPECT_EQ(WordAt(bytes, 24), 101u);
    EXPECT_EQ(WordAt(bytes, 28), 500'000'000u);
    EXPECT_EQ(WordAt(bytes, 32), 3u);
    EXPECT_EQ(WordAt(bytes, 36), 3u);
    EXPECT_EQ(bytes[42], 3);
    EXPECT_EQ(WordAt(bytes, 43), 102u);
}

TEST(PcapFileTest, AFolderThatIsNotThereIsRefused)
{
    EXPECT_THROW(PcapFile("/nonexistent/file.pcap", 0s), std::runtime_error);
}

TEST(PcapFileTest, AFullDiskIsTold)
{
    PcapFile file("/dev/null", 0s);
    EXPECT_TRUE(file.Write(0s, Frame(20)));
    EXPECT_THROW(PcapFile("/dev/full", 0s), std::runtime_error);
}

}  // namespace
}  // namespace Rabit::Radio
