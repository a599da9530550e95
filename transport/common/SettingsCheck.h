// Checks and resolves the settings that mean the same to every DDS backend.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <rabit/transport/Transport.h>

namespace Rabit
{

// Throws TransportError if a setting is out of its range.
void CheckSettings(const TransportSettings &settings);

// Throws TransportError if the depth is out of its range, 1 to 1,000,000.
void CheckQos(const TopicDescription &topic, const TopicQos &qos);

// The IPv4 addresses of the named interfaces; each entry is a name (`eth0`) or an address (`10.0.0.1`) of
// this host. Throws TransportError for one that does not exist here or has no IPv4 address.
std::vector<std::string> ResolveInterfaces(const std::vector<std::string> &interfaces);

// The IPv4 addresses, sorted, that the named interfaces have now; of all interfaces but loopback if none is
// named. Empty if they cannot be listed.
std::vector<std::string> FindAddresses(const std::vector<std::string> &interfaces);

struct PeerAddress
{
    std::string Address;     // IPv4, dotted
    std::uint16_t Port = 0;  // 0: not given
};

// Resolves `host` or `host:port`; throws TransportError if it does not parse or resolve.
PeerAddress ResolvePeer(const std::string &peer);

}  // namespace Rabit
