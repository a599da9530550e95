#include "common/PeerAddress.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <rabit/transport/Transport.h>

#include <charconv>

namespace Rabit
{

namespace
{

// True if `text` is a host name as DNS and /etc/hosts allow it.
bool IsHostName(const std::string &text)
{
    constexpr std::size_t Longest = 253;
    constexpr const char *Letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-._";
    return !text.empty() && text.size() <= Longest && text.find_first_not_of(Letters) == std::string::npos;
}

}  // namespace

bool PeerAddress::HasAddress() const
{
    return IsAddress(Host);
}

PeerAddress ParsePeer(const std::string &peer)
{
    PeerAddress result;
    result.Host = peer;
    if (const auto colon = peer.find(':'); colon != std::string::npos)
    {
        result.Host = peer.substr(0, colon);
        const char *begin = peer.data() + colon + 1;
        const char *end = peer.data() + peer.size();
        const auto [stop, error] = std::from_chars(begin, end, result.Port);
        if (error != std::errc() || stop != end || result.Port == 0)
        {
            throw TransportError("the peer " + peer + " is not of the form host or host:port", "peers");
        }
    }
    if (LooksLikeAddress(result.Host) ? !IsAddress(result.Host) : !IsHostName(result.Host))
    {
        throw TransportError("the peer " + peer + " is neither an IPv4 address nor the name of a host",
                             "peers");
    }
    return result;
}

bool IsAddress(const std::string &text)
{
    in_addr address{};
    return inet_pton(AF_INET, text.c_str(), &address) == 1;
}

bool LooksLikeAddress(const std::string &text)
{
    return !text.empty() && text.find_first_not_of("0123456789.") == std::string::npos;
}

}  // namespace Rabit
