#pragma once

#include "BadInput.h"

#include <boost/asio/ip/tcp.hpp>

#include <string>
#include <vector>

namespace Ground
{

// Thrown if an address is malformed or not available. what() is one line for a person.
class WebServerError : public Common::BadInput
{
public:
    using Common::BadInput::BadInput;
};

// `PORT`, `ADDRESS:PORT` or `[ADDRESS]:PORT`: a numerical IPv4 or IPv6 address (127.0.0.1 if there is none)
// and a port from 0 to 65535, where 0 means any free port. Throws WebServerError.
boost::asio::ip::tcp::endpoint ParseWebAddress(const std::string &text);

// The page at that address, for people: `http://127.0.0.1:8080/`, or with a token
// `http://127.0.0.1:8080/?token=...`; with TLS `https://...`.
std::string WebPageUrl(const boost::asio::ip::tcp::endpoint &endpoint, const std::string &token = {},
                       bool hasTls = false);

// The names of this machine for others: its host name, and that with `.local`. Empty if it has none.
std::vector<std::string> NamesOfThisHost();

// The addresses of a server that listens on the given one: that address, or all present ones of this
// machine if it is the unspecified address.
std::vector<boost::asio::ip::address> AddressesOf(const boost::asio::ip::address &listening);

}  // namespace Ground
