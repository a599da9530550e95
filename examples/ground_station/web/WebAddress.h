#pragma once

#include "BadInput.h"

#include <boost/asio/ip/tcp.hpp>

#include <string>
#include <vector>

namespace Ground
{

// An address that is not one, or that cannot be had. what() is one line for a person.
class WebServerError : public Common::BadInput
{
public:
    using Common::BadInput::BadInput;
};

// `PORT`, `ADDRESS:PORT` or `[ADDRESS]:PORT`: a numerical IPv4 or IPv6 address (127.0.0.1 if there is none)
// and a port from 0 to 65535, where 0 means any that is free. Throws WebServerError.
boost::asio::ip::tcp::endpoint ParseWebAddress(const std::string &text);

// The page at that address, for people: `http://127.0.0.1:8080/`, or with a token, and so with TLS,
// `https://127.0.0.1:8080/?token=...`.
std::string WebPageUrl(const boost::asio::ip::tcp::endpoint &endpoint, const std::string &token = {});

// By which others may know this machine: its host name, and that with `.local`. None if it has none.
std::vector<std::string> NamesOfThisHost();

// At which this machine is reached when a server listens there: that one, or all that it has now if it is the
// one that stands for all.
std::vector<boost::asio::ip::address> AddressesOf(const boost::asio::ip::address &listening);

}  // namespace Ground
