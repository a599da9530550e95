#include "WebAddress.h"

#include <boost/asio/ip/address.hpp>

#include <charconv>
#include <cstdint>

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

std::string WebPageUrl(const boost::asio::ip::tcp::endpoint &endpoint)
{
    const std::string address = endpoint.address().to_string();
    return "http://" + (endpoint.address().is_v6() ? "[" + address + "]" : address) + ":" +
           std::to_string(endpoint.port()) + "/";
}

}  // namespace Ground
