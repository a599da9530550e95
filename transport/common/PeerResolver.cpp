#include "common/PeerResolver.h"

#include <arpa/inet.h>
#include <netdb.h>
#include <netinet/in.h>

#include <algorithm>
#include <condition_variable>
#include <map>
#include <mutex>
#include <utility>

#include "common/StartThread.h"

namespace Rabit
{

namespace
{

constexpr std::chrono::seconds Period{1};

}  // namespace

struct PeerResolver::Shared
{
    std::mutex Mutex;
    std::condition_variable Event;
    std::map<std::string, std::string> Addresses;  // of the hosts that have one; guarded by Mutex
    bool Tried = false;                            // each host was looked up once; guarded by Mutex
    bool Stop = false;                             // guarded by Mutex
};

PeerResolver::PeerResolver(std::vector<std::string> hosts, Lookup lookup, std::chrono::milliseconds firstWait)
    : _shared(std::make_shared<Shared>())
{
    if (hosts.empty())
    {
        return;
    }
    // Detached, because the system's resolver may take half a minute and cannot be interrupted.
    StartThread([shared = _shared, hosts = std::move(hosts), lookup = std::move(lookup)]
                { Run(shared, hosts, lookup); })
        .detach();
    std::unique_lock lock(_shared->Mutex);
    _shared->Event.wait_for(lock, firstWait, [this] { return _shared->Tried; });
}

PeerResolver::~PeerResolver()
{
    {
        const std::lock_guard lock(_shared->Mutex);
        _shared->Stop = true;
    }
    _shared->Event.notify_all();
}

std::optional<std::string> PeerResolver::AddressOf(const std::string &host) const
{
    const std::lock_guard lock(_shared->Mutex);
    const auto found = _shared->Addresses.find(host);
    return found == _shared->Addresses.end() ? std::nullopt : std::optional(found->second);
}

void PeerResolver::Run(const std::shared_ptr<Shared> &shared, const std::vector<std::string> &hosts,
                       const Lookup &lookup)
{
    std::vector<std::string> open = hosts;
    while (!open.empty())
    {
        std::erase_if(open,
                      [&](const std::string &host)
                      {
                          const auto address = lookup(host);
                          const std::lock_guard lock(shared->Mutex);
                          return address && shared->Addresses.emplace(host, *address).second;
                      });
        std::unique_lock lock(shared->Mutex);
        shared->Tried = true;
        shared->Event.notify_all();
        if (shared->Event.wait_for(lock, Period, [&] { return shared->Stop; }))
        {
            return;
        }
    }
}

std::optional<std::string> PeerResolver::LookUpHost(const std::string &host)
{
    addrinfo hints{};
    hints.ai_family = AF_INET;
    hints.ai_socktype = SOCK_DGRAM;
    addrinfo *head = nullptr;
    if (getaddrinfo(host.c_str(), nullptr, &hints, &head) != 0 || head == nullptr)
    {
        return std::nullopt;
    }
    const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> list(head, &freeaddrinfo);
    char text[INET_ADDRSTRLEN] = "";
    inet_ntop(AF_INET, &reinterpret_cast<const sockaddr_in *>(head->ai_addr)->sin_addr, text, sizeof text);
    return text;
}

}  // namespace Rabit
