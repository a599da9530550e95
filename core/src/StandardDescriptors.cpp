#include <rabit/StandardDescriptors.h>

#include <cerrno>

#include <fcntl.h>
#include <unistd.h>

namespace Rabit
{

void OpenStandardDescriptors() noexcept
{
    for (int descriptor = STDIN_FILENO; descriptor <= STDERR_FILENO; ++descriptor)
    {
        if (fcntl(descriptor, F_GETFD) == -1 && errno == EBADF)
        {
            // The lowest free number is this one, since those below it are open.
            if (open("/dev/null", descriptor == STDIN_FILENO ? O_RDONLY : O_WRONLY) == -1)
            {
                return;  // without /dev/null there is nothing to put in its place
            }
        }
    }
}

}  // namespace Rabit
