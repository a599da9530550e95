#include <rabit/RabitReactor.h>
#include <rabit/StandardDescriptors.h>

#include <gtest/gtest.h>

#include <cstdlib>

#include <fcntl.h>
#include <unistd.h>

namespace
{

using namespace Rabit;

// Each test closes descriptors, and so runs in a process of its own, whose exit code tells the first check
// that failed.
class StandardDescriptorsDeathTest : public testing::Test
{
protected:
    void SetUp() override { GTEST_FLAG_SET(death_test_style, "threadsafe"); }

    static void CloseAll()
    {
        for (int descriptor = 0; descriptor <= 2; ++descriptor)
        {
            close(descriptor);
        }
    }
    // Ends the process: 0 if the next file gets none of the numbers, and each of them can be used.
    [[noreturn]] static void EndWithWhatIsLeft()
    {
        const int next = open("/dev/zero", O_RDONLY);
        char byte = 0;
        std::_Exit(next <= 2                   ? 1
                   : read(0, &byte, 1) != 0    ? 2
                   : write(1, "words", 5) != 5 ? 3
                   : write(2, "words", 5) != 5 ? 4
                                               : 0);
    }
};

TEST_F(StandardDescriptorsDeathTest, AreOpenedIfTheyAreClosed)
{
    EXPECT_EXIT(
        {
            CloseAll();
            OpenStandardDescriptors();
            EndWithWhatIsLeft();
        },
        testing::ExitedWithCode(0), "");
}

TEST_F(StandardDescriptorsDeathTest, AreOpenedWhenAReactorIsMade)
{
    EXPECT_EXIT(
        {
            CloseAll();
            RabitReactor reactor;
            EndWithWhatIsLeft();
        },
        testing::ExitedWithCode(0), "");
}

TEST_F(StandardDescriptorsDeathTest, ThatAreOpenStayWhatTheyAre)
{
    EXPECT_EXIT(
        {
            close(0);
            const int zero = open("/dev/zero", O_RDONLY);
            close(2);
            OpenStandardDescriptors();
            char byte = 1;
            std::_Exit(zero == 0 && read(0, &byte, 1) == 1 && byte == 0 && fcntl(2, F_GETFD) != -1 ? 0 : 1);
        },
        testing::ExitedWithCode(0), "");
}

}  // namespace
