// stderr in the states of the field: full, stopped, broken or closed. A test that hangs has failed.

#include <rabit/RabitLog.h>

#include <gtest/gtest.h>

#include <array>
#include <climits>
#include <cstdlib>
#include <string>

#include <fcntl.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>
#include <csignal>

namespace
{

using namespace Rabit;

void SetBlocking(int descriptor, bool blocking)
{
    const int flags = fcntl(descriptor, F_GETFL);
    fcntl(descriptor, F_SETFL, blocking ? flags & ~O_NONBLOCK : flags | O_NONBLOCK);
}

// Returns all bytes that can be read now.
std::string ReadAll(int descriptor)
{
    SetBlocking(descriptor, false);
    std::string text;
    std::array<char, PIPE_BUF> some{};
    for (ssize_t count = 0; (count = read(descriptor, some.data(), some.size())) > 0;)
    {
        text.append(some.data(), static_cast<std::size_t>(count));
    }
    return text;
}

// Writes until nothing fits; the descriptor blocks again afterwards.
void Fill(int descriptor)
{
    SetBlocking(descriptor, false);
    const std::string some(PIPE_BUF, 'x');
    for (std::size_t size = some.size(); size > 0; size /= 2)
    {
        while (write(descriptor, some.data(), size) > 0)
        {
        }
    }
    SetBlocking(descriptor, true);
}

std::string LastLines(const std::string &text, std::size_t count)
{
    std::size_t from = text.size();
    for (; from > 0 && (text[from - 1] != '\n' || count-- > 0); --from)
    {
    }
    return text.substr(from);
}

// Replaces stderr while it lives.
class UnreadStderr : public ::testing::Test
{
protected:
    UnreadStderr() : _before(dup(STDERR_FILENO))
    {
        Use(-1, open("/dev/null", O_WRONLY));
        RabitLog::Write(RabitLogLevel::Error, "takes the count of an earlier test");
    }
    ~UnreadStderr() override
    {
        dup2(_before, STDERR_FILENO);
        close(_before);
        if (_reader >= 0)
        {
            close(_reader);
        }
    }

    // Takes ownership of both descriptors.
    void Use(int reader, int writer)
    {
        _reader = reader;
        dup2(writer, STDERR_FILENO);
        close(writer);
    }
    void UsePipe()
    {
        std::array<int, 2> ends{};
        ASSERT_EQ(pipe(ends.data()), 0);
        Use(ends[0], ends[1]);
    }
    void UseTerminal()
    {
        const int master = posix_openpt(O_RDWR | O_NOCTTY);
        ASSERT_GE(master, 0);
        ASSERT_EQ(grantpt(master) + unlockpt(master), 0);
        const int slave = open(ptsname(master), O_RDWR | O_NOCTTY);
        ASSERT_GE(slave, 0);
        Use(master, slave);
    }
    // Logs lines until several were dropped, however many the descriptor holds.
    static void LogMuch()
    {
        for (int i = 0; i < 3000; ++i)
        {
            RabitLog::Write(RabitLogLevel::Error, std::string(static_cast<std::size_t>(1 + i % 200), 'y'));
        }
    }
    void CloseReader()
    {
        close(_reader);
        _reader = -1;
    }

    int _reader = -1;

private:
    const int _before;
};

TEST_F(UnreadStderr, LinesThatAFullPipeDoesNotTakeAreDroppedAndCounted)
{
    UsePipe();
    Fill(STDERR_FILENO);
    RabitLog::Write(RabitLogLevel::Error, "one");
    RabitLog::Write(RabitLogLevel::Error, "two");
    RabitLog::Write(RabitLogLevel::Error, "three");
    ReadAll(_reader);
    RabitLog::Write(RabitLogLevel::Error, "four");
    RabitLog::Write(RabitLogLevel::Error, "five");
    EXPECT_EQ(ReadAll(_reader),
              "rabit: warning: 3 lines were not written: stderr was full\nrabit: error: four\nrabit: error: "
              "five\n");
}

TEST_F(UnreadStderr, APipeGetsWholeLinesUntilItIsFull)
{
    UsePipe();
    LogMuch();
    const std::string text = ReadAll(_reader);
    EXPECT_GT(text.size(), std::size_t{PIPE_BUF});
    EXPECT_EQ(text.back(), '\n');
}

TEST_F(UnreadStderr, AFullSocketDoesNotBlock)
{
    std::array<int, 2> ends{};
    ASSERT_EQ(socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()), 0);
    Use(ends[0], ends[1]);
    Fill(STDERR_FILENO);
    RabitLog::Write(RabitLogLevel::Error, "lost");
    ReadAll(_reader);
    RabitLog::Write(RabitLogLevel::Error, "next");
    EXPECT_EQ(ReadAll(_reader),
              "rabit: warning: 1 line was not written: stderr was full\nrabit: error: next\n");
}

TEST_F(UnreadStderr, ATerminalThatNobodyReadsDoesNotBlock)
{
    UseTerminal();
    LogMuch();
    ReadAll(_reader);
    RabitLog::Write(RabitLogLevel::Error, "next");
    const std::string text = ReadAll(_reader);
    EXPECT_NE(text.find(" lines were not written: stderr was full\r\n"), std::string::npos);
    EXPECT_EQ(LastLines(text, 1), "rabit: error: next\r\n");
}

TEST_F(UnreadStderr, AStoppedTerminalDoesNotBlock)
{
    UseTerminal();
    ASSERT_EQ(tcflow(STDERR_FILENO, TCOOFF), 0);  // as Ctrl-S does
    RabitLog::Write(RabitLogLevel::Error, "lost");
    ASSERT_EQ(tcflow(STDERR_FILENO, TCOON), 0);
    RabitLog::Write(RabitLogLevel::Error, "next");
    EXPECT_EQ(ReadAll(_reader),
              "rabit: warning: 1 line was not written: stderr was full\r\nrabit: error: next\r\n");
}

TEST_F(UnreadStderr, AFullDiskCostsLinesAlone)
{
    Use(-1, open("/dev/full", O_WRONLY));
    RabitLog::Write(RabitLogLevel::Error, "lost");
    UsePipe();
    RabitLog::Write(RabitLogLevel::Error, "next");
    EXPECT_EQ(ReadAll(_reader),
              "rabit: warning: 1 line was not written: stderr was full\nrabit: error: next\n");
}

TEST_F(UnreadStderr, APipeWithoutAReaderRaisesNoSignal)
{
    UsePipe();
    CloseReader();
    RabitLog::Write(RabitLogLevel::Error, "lost");
    sigset_t pending;
    sigpending(&pending);
    EXPECT_EQ(sigismember(&pending, SIGPIPE), 0);
    UsePipe();
    RabitLog::Write(RabitLogLevel::Error, "next");
    EXPECT_EQ(ReadAll(_reader),
              "rabit: warning: 1 line was not written: stderr was full\nrabit: error: next\n");
}

TEST_F(UnreadStderr, AClosedStderrCostsLinesAlone)
{
    std::array<int, 2> ends{};
    ASSERT_EQ(pipe(ends.data()), 0);
    close(STDERR_FILENO);
    RabitLog::Write(RabitLogLevel::Error, "lost");
    Use(ends[0], ends[1]);
    RabitLog::Write(RabitLogLevel::Error, "next");
    EXPECT_EQ(ReadAll(_reader),
              "rabit: warning: 1 line was not written: stderr was full\nrabit: error: next\n");
}

TEST_F(UnreadStderr, ALineLongerThanAPipeTakesAtOnceIsCut)
{
    UsePipe();
    const std::string prefix = "rabit: error: ";
    const std::string fits(PIPE_BUF - prefix.size() - 1, 'a');
    RabitLog::Write(RabitLogLevel::Error, fits);
    EXPECT_EQ(ReadAll(_reader), prefix + fits + "\n");
    RabitLog::Write(RabitLogLevel::Error, fits + "a");
    const std::string mark = " ... (cut)\n";
    EXPECT_EQ(ReadAll(_reader), (prefix + fits).substr(0, PIPE_BUF - mark.size()) + mark);
}

TEST_F(UnreadStderr, TheLastWordsOfAProgramAreDroppedRatherThanWaitedFor)
{
    UsePipe();
    Fill(STDERR_FILENO);
    RabitLog::Print("lost");
    ReadAll(_reader);
    RabitLog::Print("uav1.yaml:4: wrong");
    EXPECT_EQ(ReadAll(_reader),
              "rabit: warning: 1 line was not written: stderr was full\nuav1.yaml:4: wrong\n");
}

}  // namespace
