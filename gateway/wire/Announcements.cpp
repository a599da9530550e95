#include "wire/Announcements.h"

#include <rabit/base/Fnv1a.h>
#include <rabit/gateway/NamePattern.h>
#include <rabit/gateway/QosProfileWords.h>
#include <rabit/idl/MessageTypeRegistry.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "names/TypeDefinition.h"
#include "wire/GatewayTopics.h"

namespace Rabit::Announcements
{
namespace
{

std::size_t OffersOf(const Gateway::Announcement &announcement)
{
    return announcement.publishes.size() + announcement.accepts.size();
}

std::size_t TypesOf(const Gateway::Announcement &announcement)
{
    return std::accumulate(announcement.accepts.begin(), announcement.accepts.end(), std::size_t{0},
                           [](std::size_t sum, const Gateway::AcceptedQueue &accepted)
                           { return sum + accepted.types.size(); });
}

bool IsState(const Gateway::PublishedMessage &published)
{
    return published.qos == WordOf(QosProfile::State);
}

bool IsType(const std::string &name)
{
    return !name.empty() && name.size() <= LongestType;
}

std::uint64_t DefinitionOf(const std::string &name)
{
    const MessageType *type = MessageTypeRegistry::Find(name);
    return type == nullptr ? 0 : DefinitionHash(*type);
}

bool IsPlausible(const Gateway::PublishedMessage &published)
{
    return IsMessageName(published.message) && IsType(published.type) && ProfileOf(published.qos).has_value();
}

bool IsPlausible(const Gateway::AcceptedQueue &accepted)
{
    return IsMessageName(accepted.queue) &&
           std::all_of(accepted.from.begin(), accepted.from.end(), IsNodePattern) &&
           std::all_of(accepted.types.begin(), accepted.types.end(),
                       [](const Gateway::QueueType &type) { return IsType(type.type); });
}

}  // namespace

Gateway::Announcement Of(const GatewayConfig &config)
{
    Gateway::Announcement announcement;
    for (const PublishRule &rule : config.Publish)
    {
        Gateway::PublishedMessage published;
        published.message = rule.Message;
        published.type = rule.Type;
        published.qos = WordOf(rule.Qos);
        published.definition = DefinitionOf(rule.Type);
        announcement.publishes.push_back(published);
    }
    for (const AcceptRule &rule : config.Accept)
    {
        Gateway::AcceptedQueue accepted;
        accepted.queue = rule.Queue;
        accepted.from.assign(rule.From.begin(), rule.From.end());
        for (const std::string &name : rule.Types)
        {
            Gateway::QueueType type;
            type.type = name;
            type.definition = DefinitionOf(name);
            accepted.types.push_back(type);
        }
        announcement.accepts.push_back(accepted);
    }
    return announcement;
}

std::vector<std::uint8_t> Encode(const Gateway::Announcement &announcement)
{
    const MessageType &type = GatewayTopics::TypeOf<Gateway::Announcement>();
    std::vector<std::uint8_t> bytes(type.SerializedSize(announcement));
    type.Serialize(announcement, bytes);
    return bytes;
}

std::optional<Gateway::Announcement> Decode(std::span<const std::uint8_t> bytes)
{
    Gateway::Announcement announcement;
    const bool good = bytes.size() <= LargestEncoded &&
                      GatewayTopics::TypeOf<Gateway::Announcement>().Deserialize(bytes, announcement) &&
                      IsPlausible(announcement);
    return good ? std::optional(std::move(announcement)) : std::nullopt;
}

// Folds the halves of the hash into one.
std::uint32_t DigestOf(std::span<const std::uint8_t> bytes)
{
    return Fnv1a().Add(bytes).Folded();
}

std::optional<std::size_t> StateIndexOf(const Gateway::Announcement &announcement, std::string_view message)
{
    std::size_t index = 0;
    for (const Gateway::PublishedMessage &published : announcement.publishes)
    {
        if (IsState(published) && published.message == message)
        {
            return index;
        }
        index += IsState(published) ? 1 : 0;
    }
    return std::nullopt;
}

std::size_t StatesIn(const Gateway::Announcement &announcement)
{
    return static_cast<std::size_t>(
        std::count_if(announcement.publishes.begin(), announcement.publishes.end(), IsState));
}

std::string WhyTooLarge(const Gateway::Announcement &announcement)
{
    const auto tooMany = [](std::size_t count, const char *what, std::size_t most)
    {
        return "this node would announce " + std::to_string(count) + " " + what + "; others take at most " +
               std::to_string(most);
    };
    if (OffersOf(announcement) > MostOffers)
    {
        return tooMany(OffersOf(announcement), "messages and queues", MostOffers);
    }
    if (TypesOf(announcement) > MostTypes)
    {
        return tooMany(TypesOf(announcement), "types of queues", MostTypes);
    }
    for (const Gateway::PublishedMessage &published : announcement.publishes)
    {
        if (!IsType(published.type))
        {
            return tooMany(published.type.size(), "bytes as the name of a type", LongestType);
        }
    }
    for (const Gateway::AcceptedQueue &accepted : announcement.accepts)
    {
        for (const Gateway::QueueType &type : accepted.types)
        {
            if (!IsType(type.type))
            {
                return tooMany(type.type.size(), "bytes as the name of a type", LongestType);
            }
        }
    }
    const std::size_t size = GatewayTopics::TypeOf<Gateway::Announcement>().SerializedSize(announcement);
    return size > LargestEncoded ? tooMany(size, "bytes of names", LargestEncoded) : "";
}

bool IsPlausible(const Gateway::Announcement &announcement)
{
    return OffersOf(announcement) <= MostOffers && TypesOf(announcement) <= MostTypes &&
           std::all_of(announcement.publishes.begin(), announcement.publishes.end(),
                       [](const auto &published) { return IsPlausible(published); }) &&
           std::all_of(announcement.accepts.begin(), announcement.accepts.end(),
                       [](const auto &accepted) { return IsPlausible(accepted); });
}

}  // namespace Rabit::Announcements
