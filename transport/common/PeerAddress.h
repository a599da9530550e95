// One of TransportSettings::Peers.
#pragma once

#include <cstdint>
#include <string>

namespace Rabit
{

struct PeerAddress
{
    std::string Host;        // a name, or an IPv4 address, dotted
    std::uint16_t Port = 0;  // 0: not given

    bool HasAddress() const;
};

// Parses `host` or `host:port`; throws TransportError if it is neither.
PeerAddress ParsePeer(const std::string &peer);

// True if `text` is a dotted IPv4 address.
bool IsAddress(const std::string &text);
// True if `text` consists of digits and dots, so that it cannot be a name.
bool LooksLikeAddress(const std::string &text);

}  // namespace Rabit
