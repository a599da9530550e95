#include "common/ParticipantIdentity.h"

#include <charconv>
#include <string_view>

namespace Rabit
{

namespace
{

constexpr std::string_view Prefix = "rabit=1;incarnation=";
constexpr std::string_view Card = ";card=2;";

}  // namespace

std::string MakeEndpointUserData(std::string_view typeHash)
{
    std::string text(EndpointUserData);
    return typeHash.empty() ? text : text.append("typehash=").append(typeHash).append(";");
}

std::string MakeUserData(std::uint64_t incarnation, bool hasCard)
{
    return std::string(Prefix) + std::to_string(incarnation) + std::string(hasCard ? Card : ";");
}

bool HasCard(std::span<const std::uint8_t> userData)
{
    const std::string_view text(reinterpret_cast<const char *>(userData.data()), userData.size());
    return ParseUserData(userData) && text.ends_with(Card);
}

std::optional<std::uint64_t> ParseUserData(std::span<const std::uint8_t> userData)
{
    const std::string_view text(reinterpret_cast<const char *>(userData.data()), userData.size());
    if (!text.starts_with(Prefix))
    {
        return std::nullopt;
    }
    const std::string_view digits = text.substr(Prefix.size());
    std::uint64_t incarnation = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), incarnation);
    if (error != std::errc() || end == digits.data() + digits.size() || *end != ';')
    {
        return std::nullopt;
    }
    return incarnation;
}

}  // namespace Rabit
