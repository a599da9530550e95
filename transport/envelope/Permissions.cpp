#include "envelope/Permissions.h"

#include <algorithm>
#include <utility>

#include "common/RtpsWriter.h"
#include "envelope/KeyDerivation.h"

namespace Rabit::Envelope
{

namespace
{

constexpr std::uint8_t PermissionsFormat = 1;
constexpr std::uint8_t WriteBit = 1;
constexpr std::uint8_t ReadBit = 2;
constexpr std::string_view OwnTopics = "rabit/";  // of gateways: beats and links

bool IsPermissionRule(const Permissions::Rule &rule)
{
    const auto stars = static_cast<std::size_t>(std::count(rule.Topic.begin(), rule.Topic.end(), '*'));
    return !rule.Topic.empty() && rule.Topic.size() <= Permissions::LongestTopic &&
           stars <= Permissions::MostStars && (rule.MayWrite || rule.MayRead);
}

// Goes back to the last star alone: at most the product of both lengths.
bool MatchesTopic(std::string_view pattern, std::string_view topic)
{
    std::size_t p = 0;
    std::size_t t = 0;
    std::size_t star = std::string_view::npos;
    std::size_t behindStar = 0;
    while (t < topic.size())
    {
        // The star first: a topic may contain one, which a star in the pattern still has to stand for.
        if (p < pattern.size() && pattern[p] == '*')
        {
            star = p++;
            behindStar = t;
        }
        else if (p < pattern.size() && (pattern[p] == '?' || pattern[p] == topic[t]))
        {
            ++p;
            ++t;
        }
        else if (star != std::string_view::npos)
        {
            p = star + 1;
            t = ++behindStar;
        }
        else
        {
            return false;
        }
    }
    return pattern.find_first_not_of('*', p) == std::string_view::npos;
}

}  // namespace

std::optional<Permissions> Permissions::Of(std::vector<Rule> rules)
{
    if (rules.size() > MostRules || !std::all_of(rules.begin(), rules.end(), IsPermissionRule))
    {
        return std::nullopt;
    }
    Permissions made(std::move(rules));
    return made.Bytes().size() <= LargestList ? std::optional(std::move(made)) : std::nullopt;
}

std::optional<Permissions> Permissions::Read(std::span<const std::uint8_t> bytes)
{
    if (bytes.empty() || bytes.size() > LargestList || bytes[0] != PermissionsFormat)
    {
        return std::nullopt;
    }
    std::vector<Rule> rules;
    auto rest = bytes.subspan(1);
    while (!rest.empty())
    {
        constexpr std::size_t FrontSize = 2;
        if (rest.size() < FrontSize || rest.size() - FrontSize < rest[1] || rest[0] > (WriteBit | ReadBit) ||
            rules.size() == MostRules)
        {
            return std::nullopt;
        }
        const auto topic = rest.subspan(FrontSize, rest[1]);
        rules.push_back({.Topic = std::string(topic.begin(), topic.end()),
                         .MayWrite = (rest[0] & WriteBit) != 0,
                         .MayRead = (rest[0] & ReadBit) != 0});
        rest = rest.subspan(FrontSize + topic.size());
    }
    return Of(std::move(rules));
}

std::vector<std::uint8_t> Permissions::Bytes() const
{
    std::vector<std::uint8_t> bytes{PermissionsFormat};
    for (const Rule &rule : _rules)
    {
        bytes.push_back(
            static_cast<std::uint8_t>((rule.MayWrite ? WriteBit : 0) | (rule.MayRead ? ReadBit : 0)));
        bytes.push_back(static_cast<std::uint8_t>(rule.Topic.size()));
        Rtps::Append(bytes,
                     std::span(reinterpret_cast<const std::uint8_t *>(rule.Topic.data()), rule.Topic.size()));
    }
    return bytes;
}

Hash Permissions::HashOf(std::span<const std::uint8_t> bytes)
{
    return Sha256(bytes);
}

bool Permissions::MayWrite(std::string_view topic, CertificateRole role) const
{
    return (role == CertificateRole::Node || topic.starts_with(OwnTopics)) &&
           std::any_of(_rules.begin(), _rules.end(),
                       [topic](const Rule &rule)
                       { return rule.MayWrite && MatchesTopic(rule.Topic, topic); });
}

bool Permissions::MayRead(std::string_view topic) const
{
    return std::any_of(_rules.begin(), _rules.end(),
                       [topic](const Rule &rule) { return rule.MayRead && MatchesTopic(rule.Topic, topic); });
}

}  // namespace Rabit::Envelope
