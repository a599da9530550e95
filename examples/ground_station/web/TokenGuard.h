#pragma once

#include <boost/asio/ip/address.hpp>

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace Ground
{

// Knows the token of a page, and slows down who tries others.
//
// A token is not looked at before a pause that grows with the wrong ones that came from its address lately,
// and with those of all addresses; one wrong token is forgotten in ForgetsOneIn. The pause has an end, so
// that the right token gets through from wherever it comes, and an address that has shown it does not pay for
// the others'. Neighbours in one IPv6 network (64 bits) count as one address.
//
// What is kept is bounded. Not thread-safe; the time is what the caller says, and never goes back.
class TokenGuard
{
public:
    using Address = boost::asio::ip::address;
    using Time = std::chrono::steady_clock::time_point;

    static constexpr double FreeOfOne = 5;    // wrong tokens before it becomes slow
    static constexpr double FreeOfAll = 50;   // for addresses that never showed the right one
    static constexpr double Remembered = 15;  // beyond what is free; so an attack is forgotten when it ends
    static constexpr std::chrono::milliseconds FirstPause{250};
    static constexpr std::chrono::milliseconds LongestPause{4000};
    static constexpr std::chrono::seconds ForgetsOneIn{10};
    static constexpr std::chrono::seconds BetweenLines{10};
    static constexpr std::size_t MostAddresses = 256;
    static constexpr std::size_t MostInALine = 4;

    explicit TokenGuard(std::string_view token);

    // How long to wait before a token from there is looked at.
    std::chrono::milliseconds PauseFor(const Address &from, Time now) const;
    // Whether it is the token. Takes as long for each of that length.
    bool IsRight(const Address &from, std::string_view shown, Time now);
    // What is to be logged of wrong ones now, if anything: a line in BetweenLines at most.
    std::optional<std::string> Line(Time now);

private:
    using Digest = std::array<unsigned char, 32>;

    // Rises by one, and falls with time.
    struct Level
    {
        double Height = 0;
        Time At{};

        double Now(Time now) const;
        void Rise(Time now, double most);
    };
    struct Visitor
    {
        Level Wrong;
        bool WasRight = false;
    };

    static Digest DigestOf(std::string_view text);
    static Address NetworkOf(const Address &from);
    Visitor &VisitorFrom(const Address &from, Time now);

    const Digest _token;
    std::map<Address, Visitor> _visitors;
    Level _wrongOfAll;
    std::map<Address, std::uint64_t> _unsaid;  // wrong tokens since the last line
    std::uint64_t _unsaidOfOthers = 0;
    std::optional<Time> _said;
};

}  // namespace Ground
