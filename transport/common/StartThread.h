#pragma once

#include <rabit/transport/Transport.h>

#include <string>
#include <system_error>
#include <thread>
#include <utility>

namespace Rabit
{

// Starts a thread. Throws TransportError if the system has no room for one.
template <typename Work>
std::thread StartThread(Work work)
{
    try
    {
        return std::thread(std::move(work));
    }
    catch (const std::system_error &error)
    {
        throw TransportError("a thread cannot be started: " + error.code().message() +
                             "; raise the limit of threads (ulimit -u, pids.max), or end other programs");
    }
}

}  // namespace Rabit
