// The serial port of a channel, on a pseudo terminal instead of the device.
#include "mavlink/ByteChannel.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <memory>
#include <numeric>
#include <span>
#include <string>
#include <vector>

namespace
{
using testing::HasSubstr;
using namespace std::chrono_literals;
using Bytes = std::vector<std::uint8_t>;

// Returns every byte value, including those that a terminal treats as commands (interrupt, end of line,
// stop).
Bytes AllValues()
{
    Bytes bytes(256);
    std::iota(bytes.begin(), bytes.end(), std::uint8_t{0});
    return bytes;
}

class SerialChannel : public testing::Test
{
protected:
    int _far = -1;  // the other end
    std::unique_ptr<Swarm::ByteChannel> _channel;

    void SetUp() override
    {
        _far = posix_openpt(O_RDWR | O_NOCTTY);
        ASSERT_GE(_far, 0);
        ASSERT_EQ(grantpt(_far), 0);
        ASSERT_EQ(unlockpt(_far), 0);
        std::array<char, 64> name{};
        ASSERT_EQ(ptsname_r(_far, name.data(), name.size()), 0);
        _channel = Swarm::OpenByteChannel("serial:" + std::string(name.data()) + ":57600");
    }
    void TearDown() override { close(_far); }

    // Waits until the kernel has delivered this many bytes.
    template <typename Read>
    static Bytes Collect(std::size_t count, Read read)
    {
        Bytes all;
        for (int tries = 0; all.size() < count && tries < 10000; ++tries)
        {
            std::array<std::uint8_t, 100> some{};
            const std::size_t size = read(some);
            all.insert(all.end(), some.begin(), some.begin() + static_cast<std::ptrdiff_t>(size));
            if (size == 0)
                poll(nullptr, 0, 1);
        }
        return all;
    }
    Bytes ReceivedFarAway(std::size_t count)
    {
        return Collect(count,
                       [&](std::span<std::uint8_t> buffer)
                       {
                           pollfd ready{_far, POLLIN, 0};
                           if (poll(&ready, 1, 0) <= 0)
                               return std::size_t{0};
                           const ssize_t size = read(_far, buffer.data(), buffer.size());
                           return size > 0 ? static_cast<std::size_t>(size) : 0;
                       });
    }
};

TEST_F(SerialChannel, SendsEveryByteAsItIs)
{
    ASSERT_TRUE(_channel->Send(AllValues()));
    EXPECT_EQ(ReceivedFarAway(256), AllValues());
}

TEST_F(SerialChannel, ReceivesEveryByteAsItIsAndEchoesNothing)
{
    const Bytes sent = AllValues();
    ASSERT_EQ(write(_far, sent.data(), sent.size()), 256);
    EXPECT_EQ(Collect(256, [&](std::span<std::uint8_t> buffer) { return _channel->Receive(buffer, 0s); }),
              sent);
    pollfd ready{_far, POLLIN, 0};
    EXPECT_EQ(poll(&ready, 1, 0), 0);
}

TEST_F(SerialChannel, DoesNotWaitForBytes)
{
    std::array<std::uint8_t, 10> buffer{};
    EXPECT_EQ(_channel->Receive(buffer, 0s), 0u);
}

TEST_F(SerialChannel, HasNothingMoreWhenTheDeviceIsGone)
{
    close(_far);
    std::array<std::uint8_t, 10> buffer{};
    EXPECT_EQ(_channel->Receive(buffer, 0s), 0u);
    EXPECT_FALSE(_channel->Send(AllValues()));
    _far = posix_openpt(O_RDWR | O_NOCTTY);
}

TEST(OpenByteChannel, NamesADeviceThatIsNotThere)
{
    try
    {
        Swarm::OpenByteChannel("serial:/dev/no_such_device:57600");
        FAIL();
    }
    catch (const Swarm::ChannelError &error)
    {
        EXPECT_THAT(error.what(), HasSubstr("serial:/dev/no_such_device:57600: No such file"));
    }
}

}  // namespace
