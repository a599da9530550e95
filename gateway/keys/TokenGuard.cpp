#include <rabit/keys/TokenGuard.h>

#include <openssl/crypto.h>
#include <openssl/sha.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace Rabit::Keys
{

double TokenGuard::Level::Now(Time now) const
{
    const double passed = std::chrono::duration<double>(now - At) / ForgetsOneIn;
    return std::max(0.0, Height - std::max(0.0, passed));
}

void TokenGuard::Level::Rise(Time now, double most)
{
    Height = std::min(Now(now) + 1, most);
    At = now;
}

TokenGuard::TokenGuard(std::string_view token, std::string what)
    : _token(DigestOf(token)), _what(std::move(what))
{
}

std::chrono::milliseconds TokenGuard::PauseFor(const Address &from, Time now) const
{
    const auto found = _visitors.find(NetworkOf(from));
    const bool wasRight = found != _visitors.end() && found->second.WasRight;
    const double ofOne = found == _visitors.end() ? 0 : found->second.Wrong.Now(now) - FreeOfOne;
    const double ofAll = wasRight ? 0 : _wrongOfAll.Now(now) - FreeOfAll;
    const double over = std::max(ofOne, ofAll);
    if (over <= 0)
    {
        return std::chrono::milliseconds(0);
    }
    const double longest = static_cast<double>(LongestPause.count());
    return std::chrono::milliseconds(static_cast<std::chrono::milliseconds::rep>(
        std::min(longest, static_cast<double>(FirstPause.count()) * std::exp2(std::min(over, 16.0)))));
}

bool TokenGuard::IsRight(const Address &from, std::string_view shown, Time now)
{
    const Digest digest = DigestOf(shown);
    Visitor &visitor = VisitorFrom(NetworkOf(from), now);
    if (CRYPTO_memcmp(digest.data(), _token.data(), digest.size()) == 0)
    {
        visitor.WasRight = true;
        return true;
    }
    visitor.Wrong.Rise(now, FreeOfOne + Remembered);
    _wrongOfAll.Rise(now, FreeOfAll + Remembered);
    if (_unsaid.contains(from) || _unsaid.size() < MostInALine)
    {
        ++_unsaid[from];
    }
    else
    {
        ++_unsaidOfOthers;
    }
    return false;
}

std::optional<std::string> TokenGuard::Line(Time now)
{
    if (_unsaid.empty() || (_said && now - *_said < BetweenLines))
    {
        return std::nullopt;
    }
    const auto times = [](std::uint64_t count)
    { return count == 1 ? std::string("once") : std::to_string(count) + " times"; };
    std::string line;
    for (const auto &[address, count] : _unsaid)
    {
        line += (line.empty() ? _what + " was shown a wrong token: from " : ", from ") + address.to_string() +
                " " + times(count);
    }
    if (_unsaidOfOthers > 0)
    {
        line += ", from others " + times(_unsaidOfOthers);
    }
    _unsaid.clear();
    _unsaidOfOthers = 0;
    _said = now;
    return line;
}

TokenGuard::Digest TokenGuard::DigestOf(std::string_view text)
{
    Digest digest{};
    SHA256(reinterpret_cast<const unsigned char *>(text.data()), text.size(), digest.data());
    return digest;
}

TokenGuard::Address TokenGuard::NetworkOf(const Address &from)
{
    constexpr std::size_t networkBytes = 8;
    if (!from.is_v6())
    {
        return from;
    }
    if (from.to_v6().is_v4_mapped())
    {
        return boost::asio::ip::make_address_v4(boost::asio::ip::v4_mapped, from.to_v6());
    }
    auto bytes = from.to_v6().to_bytes();
    std::fill(bytes.begin() + networkBytes, bytes.end(), static_cast<unsigned char>(0));
    return boost::asio::ip::address_v6(bytes);
}

TokenGuard::Visitor &TokenGuard::VisitorFrom(const Address &from, Time now)
{
    const auto found = _visitors.find(from);
    if (found != _visitors.end())
    {
        return found->second;
    }
    if (_visitors.size() >= MostAddresses)
    {
        // Forgets the address with the fewest wrong tokens; addresses that showed the right token are kept
        // longest.
        const auto least =
            std::min_element(_visitors.begin(), _visitors.end(),
                             [now](const auto &a, const auto &b)
                             {
                                 const auto worth = [now](const Visitor &visitor)
                                 { return std::make_pair(visitor.WasRight, visitor.Wrong.Now(now)); };
                                 return worth(a.second) < worth(b.second);
                             });
        _visitors.erase(least);
    }
    return _visitors[from];
}

}  // namespace Rabit::Keys
