// Looks up the names of hosts in the background, again and again until each has an address: a name may have
// none before there is a network.
#pragma once

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
    // Gives the IPv4 address of a host now, or none; may block for as long as it likes.
    using Lookup = std::function<std::optional<std::string>(const std::string &host)>;

    // Waits for the first answers for at most a second, so that what is known at once is known at once.
    explicit PeerResolver(std::vector<std::string> hosts, Lookup lookup = &LookUpHost);
    // Does not wait for a lookup under way, which ends by itself.
    ~PeerResolver();
    PeerResolver(const PeerResolver &) = delete;
    PeerResolver &operator=(const PeerResolver &) = delete;

    // None as long as the host has none, or if it is not one of those to look up. An address that is found
    // stays.
    std::optional<std::string> AddressOf(const std::string &host) const;

    // By the system's resolver.
    static std::optional<std::string> LookUpHost(const std::string &host);

private:
    struct Shared;

    static void Run(const std::shared_ptr<Shared> &shared, const std::vector<std::string> &hosts,
                    const Lookup &lookup);

    const std::shared_ptr<Shared> _shared;
};

}  // namespace Rabit
