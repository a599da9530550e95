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

namespace Rabit::Keys
{

// Checks the token of a server (AccessToken.h), and slows down attempts with wrong tokens.
//
// A token is checked only after a pause. The pause grows with the recent wrong tokens from its address and
// from all addresses; one wrong token is forgotten in ForgetsOneIn. The pause is limited, so that the right
// token gets through from every address. For an address that has shown the right one, wrong tokens of other
// addresses do not count. Addresses in one IPv6 network (64 bits) count as one.
//
// Memory is bounded. Not thread-safe; the caller passes the time, which must never go back.
class TokenGuard
{
public:
    using Address = boost::asio::ip::address;
    using Time = std::chrono::steady_clock::time_point;

    static constexpr double FreeOfOne = 5;    // wrong tokens before pauses begin
    static constexpr double FreeOfAll = 50;   // for addresses that never showed the right one
    static constexpr double Remembered = 15;  // limit above the free ones, so that an attack is soon
                                              // forgotten
    static constexpr std::chrono::milliseconds FirstPause{250};
    static constexpr std::chrono::milliseconds LongestPause{4000};
    static constexpr std::chrono::seconds ForgetsOneIn{10};
    static constexpr std::chrono::seconds BetweenLines{10};
    static constexpr std::size_t MostAddresses = 256;
    static constexpr std::size_t MostInALine = 4;

    // `what`: the server, for Line, such as "The web page".
    explicit TokenGuard(std::string_view token, std::string what = "The web page");

    // The pause before a token from that address may be checked.
    std::chrono::milliseconds PauseFor(const Address &from, Time now) const;
    // True if it is the token. The time taken depends only on the length.
    bool IsRight(const Address &from, std::string_view shown, Time now);
    // The log line about wrong tokens, if one is due: at most one in BetweenLines.
    std::optional<std::string> Line(Time now);

private:
    using Digest = std::array<unsigned char, 32>;

    // A level that rises by one for each wrong token, and falls with time.
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
    const std::string _what;
    std::map<Address, Visitor> _visitors;
    Level _wrongOfAll;
    std::map<Address, std::uint64_t> _unsaid;  // wrong tokens since the last line
    std::uint64_t _unsaidOfOthers = 0;
    std::optional<Time> _said;
};

}  // namespace Rabit::Keys
