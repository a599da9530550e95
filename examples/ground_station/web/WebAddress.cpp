#include "WebAddress.h"

#include <boost/asio/ip/address.hpp>
#include <boost/asio/ip/host_name.hpp>

#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>

namespace Ground
{
namespace
{
[[noreturn]] void Refuse(const std::string &text, const std::string &reason)
{
    throw WebServerError("--web " + text + ": " + reason);
}

std::uint16_t ParsePort(const std::string &text, const std::string &port)
{
    std::uint16_t number = 0;
    const char *const end = port.data() + port.size();
    const auto result = std::from_chars(port.data(), end, number);
    if (port.empty() || result.ec != std::errc() || result.ptr != end)
        Refuse(text, "expected a port from 0 to 65535, found '" + port + "'");
    return number;
}

using boost::asio::ip::address;

// The address of an interface; nothing if no browser can reach it from elsewhere.
std::optional<address> AddressIn(const ifaddrs &one)
{
    if (one.ifa_addr == nullptr || (one.ifa_flags & IFF_UP) == 0 || (one.ifa_flags & IFF_LOOPBACK) != 0)
        return std::nullopt;
    if (one.ifa_addr->sa_family == AF_INET)
    {
        sockaddr_in found{};
        std::memcpy(&found, one.ifa_addr, sizeof(found));
        return boost::asio::ip::address_v4(ntohl(found.sin_addr.s_addr));
    }
    if (one.ifa_addr->sa_family != AF_INET6)
        return std::nullopt;
    sockaddr_in6 found{};
    std::memcpy(&found, one.ifa_addr, sizeof(found));
    boost::asio::ip::address_v6::bytes_type bytes{};
    std::memcpy(bytes.data(), &found.sin6_addr, bytes.size());
    const boost::asio::ip::address_v6 v6(bytes);
    return v6.is_link_local() ? std::nullopt : std::optional<address>(v6);
}
}  // namespace

boost::asio::ip::tcp::endpoint ParseWebAddress(const std::string &text)
{
    const std::size_t colon = text.rfind(':');
    if (colon == std::string::npos)
        return {boost::asio::ip::address_v4::loopback(), ParsePort(text, text)};
    std::string host = text.substr(0, colon);
    const bool bracketed = host.size() > 2 && host.front() == '[' && host.back() == ']';
    if (bracketed)
        host = host.substr(1, host.size() - 2);
    boost::system::error_code error;
    const auto address = boost::asio::ip::make_address(host, error);
    if (error || address.is_v6() != bracketed)
        Refuse(text, "expected PORT, ADDRESS:PORT or [ADDRESS]:PORT with a numerical address");
    return {address, ParsePort(text, text.substr(colon + 1))};
}

std::string WebPageUrl(const boost::asio::ip::tcp::endpoint &endpoint, const std::string &token, bool hasTls)
{
    const std::string host = endpoint.address().to_string();
    return (hasTls ? "https://" : "http://") + (endpoint.address().is_v6() ? "[" + host + "]" : host) + ":" +
           std::to_string(endpoint.port()) + "/" + (token.empty() ? "" : "?token=" + token);
}

std::vector<std::string> NamesOfThisHost()
{
    boost::system::error_code error;
    const std::string name = boost::asio::ip::host_name(error);
    const bool isName =
        !error && !name.empty() &&
        std::all_of(name.begin(), name.end(),
                    [](unsigned char c) { return std::isalnum(c) != 0 || c == '-' || c == '.'; });
    return isName ? std::vector<std::string>{name, name + ".local"} : std::vector<std::string>{};
}

std::vector<address> AddressesOf(const address &listening)
{
    if (!listening.is_unspecified())
        return {listening};
    std::vector<address> addresses;
    ifaddrs *all = nullptr;
    if (getifaddrs(&all) != 0)
        return {listening};
    const std::unique_ptr<ifaddrs, decltype(&freeifaddrs)> owner(all, &freeifaddrs);
    for (const ifaddrs *one = all; one != nullptr; one = one->ifa_next)
        if (const auto found = AddressIn(*one); found && (found->is_v4() || listening.is_v6()))
            addresses.push_back(*found);
    return addresses.empty() ? std::vector<address>{listening} : addresses;
}

}  // namespace Ground
