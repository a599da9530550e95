#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

// What a server and a viewer say to each other by the Foxglove WebSocket protocol, version 1: a server offers
// channels, a viewer subscribes to some of them. Pure. What comes from a viewer is looked at without trust.
// (https://github.com/foxglove/ws-protocol/blob/main/docs/spec.md)
namespace Rabit::Tool::LiveProtocol
{

// Names of the protocol in the HTTP request. Viewers of today ask for the second, and say the same.
inline constexpr std::string_view Names[] = {"foxglove.websocket.v1", "foxglove.sdk.v1"};

struct Channel
{
    std::uint32_t Id = 0;
    std::string Topic;
    std::string Encoding = "cdr";
    std::string SchemaName{};
    std::string SchemaText{};
    std::string SchemaEncoding = "omgidl";
};

// Which of the names that a request asks for, by commas, this server speaks; empty: none.
std::optional<std::string_view> ChosenOf(std::string_view asked);

// Texts for a viewer.
std::string ServerInfo(const std::string &name, const std::string &session);
std::string Advertise(std::span<const Channel> channels);
enum class Level : int
{
    Info = 0,
    Warning = 1,
    Error = 2
};
// A later one with the same id takes its place on the screen.
std::string Status(Level level, const std::string &message, const std::string &id = "");

// A value for a subscription, with the time when it came, UTC in nanoseconds since 1970.
std::vector<std::uint8_t> MessageData(std::uint32_t subscription, std::uint64_t time,
                                      std::span<const std::uint8_t> bytes);
inline constexpr std::size_t MessageDataHeader = 1 + 4 + 8;

// What a viewer wants.
struct Request
{
    enum class Kind
    {
        Subscribe,
        Unsubscribe,
        Unknown
    };
    struct Subscription
    {
        std::uint32_t Id = 0;
        std::uint32_t Channel = 0;
    };
    Kind What = Kind::Unknown;
    std::vector<Subscription> Subscriptions{};  // of Subscribe
    std::vector<std::uint32_t> Ids{};           // of Unsubscribe
    std::string Problem{};                      // of Unknown: in words, for its person
};
Request ReadRequest(std::string_view text);

}  // namespace Rabit::Tool::LiveProtocol
