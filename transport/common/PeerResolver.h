// Looks up host names in the background, repeatedly until each has an address: a name may have none before
// there is a network.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace Rabit
{

class PeerResolver
{
public:
    // Returns the IPv4 address of a host now, or none; may block for any time.
    using Lookup = std::function<std::optional<std::string>(const std::string &host)>;

    // Waits at most `firstWait` for the first answers, so that names that resolve at once have their address
    // on return.
    explicit PeerResolver(std::vector<std::string> hosts, Lookup lookup = &LookUpHost,
                          std::chrono::milliseconds firstWait = std::chrono::seconds(1));
    // Does not wait for a lookup in progress, which ends by itself.
    ~PeerResolver();
    PeerResolver(const PeerResolver &) = delete;
    PeerResolver &operator=(const PeerResolver &) = delete;

    // The address found; none if there is none yet, or if the host is not in the list. A found address stays.
    std::optional<std::string> AddressOf(const std::string &host) const;

    // Looks up the host with the system's resolver.
    static std::optional<std::string> LookUpHost(const std::string &host);

private:
    struct Shared;

    static void Run(const std::shared_ptr<Shared> &shared, const std::vector<std::string> &hosts,
                    const Lookup &lookup);

    const std::shared_ptr<Shared> _shared;
};

}  // namespace Rabit
