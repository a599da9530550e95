#include "DomainLease.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <stdexcept>
#include <string>

namespace Rabit::Conformance
{

namespace
{

// Above 100, the ports of a domain fall into the range from which the kernel gives ports away.
constexpr int FirstDomain = 20;
constexpr int LastDomain = 100;

}  // namespace

DomainLease::DomainLease()
{
    for (int domain = FirstDomain; domain <= LastDomain; ++domain)
    {
        const std::string name = "/tmp/rabit-test-domain-" + std::to_string(domain);
        const int lock = open(name.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
        if (lock >= 0 && flock(lock, LOCK_EX | LOCK_NB) == 0)
        {
            _domain = domain;
            _lock = lock;
            return;
        }
        if (lock >= 0)
        {
            close(lock);
        }
    }
    throw std::runtime_error("all DDS domains for tests are taken");
}

DomainLease::~DomainLease()
{
    close(_lock);
}

}  // namespace Rabit::Conformance
