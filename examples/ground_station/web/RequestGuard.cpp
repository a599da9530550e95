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
// The host without its port; nothing if the Host header is malformed.
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

RequestGuard::RequestGuard(bool boundToLoopback, std::vector<std::string> names, bool hasTls)
    : _loopback(boundToLoopback), _names(std::move(names)), _hasTls(hasTls)
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
    return !error ||
           std::any_of(_names.begin(), _names.end(),
                       [&name](const std::string &one) { return boost::algorithm::iequals(*name, one); });
}

bool RequestGuard::IsOriginAllowed(std::string_view origin, std::string_view host) const
{
    // https without TLS: behind a proxy that ends it.
    for (const std::string_view scheme : {"https://", "http://"})
        if ((scheme == "https://" || !_hasTls) && origin.substr(0, scheme.size()) == scheme &&
            boost::algorithm::iequals(origin.substr(scheme.size()), host))
            return true;
    return false;
}

}  // namespace Ground
