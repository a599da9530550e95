#include "DomainLease.h"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <string>

namespace Rabit::Conformance
{

namespace
{

// Above 100, the ports of a domain fall into the range from which the kernel gives ports away.
constexpr int FirstDomain = 20;
constexpr int LastDomain = 99;

// Binds a socket to a name of the abstract namespace of Unix sockets. That belongs to the network namespace,
// as domains do. The name is free again when its process ends. tests/integration/harness.py takes the same
// names.
bool Bind(int socket, const std::string &name)
{
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::copy(name.begin(), name.end(), address.sun_path + 1);
    const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
    return bind(socket, reinterpret_cast<const sockaddr *>(&address), size) == 0;
}

}  // namespace

DomainLease::DomainLease()
{
    for (int domain = FirstDomain; domain <= LastDomain; ++domain)
    {
        const int lease = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
        if (lease >= 0 && Bind(lease, "rabit-test-domain-" + std::to_string(domain)))
        {
            _domain = domain;
            _lease = lease;
            return;
        }
        if (lease >= 0)
        {
            close(lease);
        }
    }
    throw std::runtime_error("all DDS domains for tests are taken");
}

DomainLease::~DomainLease()
{
    close(_lease);
}

}  // namespace Rabit::Conformance
