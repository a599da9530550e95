// A process that can open no more files, as one that has used all its descriptors.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

namespace Rabit
{

// While it lives, this process can open no file but `spare` ones at a time; what is open stays open.
class NoDescriptors
{
public:
    explicit NoDescriptors(unsigned spare = 0)
    {
        const int lowest = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
        EXPECT_GE(lowest, 0);
        ::close(lowest);
        EXPECT_EQ(::getrlimit(RLIMIT_NOFILE, &_before), 0);
        rlimit limit = _before;
        limit.rlim_cur = static_cast<rlim_t>(lowest) + spare;
        EXPECT_EQ(::setrlimit(RLIMIT_NOFILE, &limit), 0);
    }
    ~NoDescriptors() { ::setrlimit(RLIMIT_NOFILE, &_before); }
    NoDescriptors(const NoDescriptors &) = delete;
    NoDescriptors &operator=(const NoDescriptors &) = delete;

private:
    rlimit _before{};
};

}  // namespace Rabit
