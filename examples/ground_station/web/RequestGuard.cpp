#include "RequestGuard.h"

#include <boost/algorithm/string/predicate.hpp>
#include <boost/asio/ip/address.hpp>

#include <algorithm>
#include <optional>
#include <utility>

namespace Ground
{
namespace
{
// The host without its port; nothing if that is not how a Host header is written.
std::optional<std::string> NameOf(std::string_view host)
{
    std::size_t end = host.find(':');
    if (!host.empty() && host.front() == '[')
    {
        end = host.find(']');
        if (end == std::string_view::npos)
            return std::nullopt;
        ++end;
    }
    end = std::min(end, host.size());
    const std::string_view port = host.substr(end);
    const bool portFits = port.empty() || (port.size() >= 2 && port.size() <= 6 && port.front() == ':' &&
                                           std::all_of(port.begin() + 1, port.end(),
                                                       [](char c) { return c >= '0' && c <= '9'; }));
    if (end == 0 || !portFits)
        return std::nullopt;
    if (host.front() == '[')
        return std::string(host.substr(1, end - 2));
    return std::string(host.substr(0, end));
}
}  // namespace

RequestGuard::RequestGuard(bool boundToLoopback, std::string hostName)
    : _loopback(boundToLoopback), _hostName(std::move(hostName))
{
}

bool RequestGuard::IsHostAllowed(std::string_view host) const
{
    const std::optional<std::string> name = NameOf(host);
    if (!name)
        return false;
    if (boost::algorithm::iequals(*name, "localhost"))
        return true;
    boost::system::error_code error;
    const auto address = boost::asio::ip::make_address(*name, error);
    if (_loopback)
        return !error && address.is_loopback();
    return !error || (!_hostName.empty() && (boost::algorithm::iequals(*name, _hostName) ||
                                             boost::algorithm::iequals(*name, _hostName + ".local")));
}

bool RequestGuard::IsOriginAllowed(std::string_view origin, std::string_view host)
{
    // https: behind a proxy that ends TLS.
    for (const std::string_view scheme : {"http://", "https://"})
        if (origin.substr(0, scheme.size()) == scheme &&
            boost::algorithm::iequals(origin.substr(scheme.size()), host))
            return true;
    return false;
}

}  // namespace Ground
