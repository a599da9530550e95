#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

// The Foxglove WebSocket protocol, version 1, between a server and a viewer: the server offers channels, the
// viewer subscribes to some of them. Pure. Requests of a viewer are read without trust.
// (https://github.com/foxglove/ws-protocol/blob/main/docs/spec.md)
namespace Rabit::Tool::LiveProtocol
{

// Names of the protocol in the HTTP request. Newer viewers ask for the second, which means the same protocol.
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

// Returns the first name in a request's comma-separated list that this server speaks; empty if there is none.
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
// A later status with the same id replaces it on the screen.
std::string Status(Level level, const std::string &message, const std::string &id = "");

// Returns a value for a subscription; `time` is its arrival, UTC in nanoseconds since 1970.
std::vector<std::uint8_t> MessageData(std::uint32_t subscription, std::uint64_t time,
                                      std::span<const std::uint8_t> bytes);
inline constexpr std::size_t MessageDataHeader = 1 + 4 + 8;

// A request of a viewer.
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
    std::string Problem{};                      // of Unknown: the reason, for people
};
Request ReadRequest(std::string_view text);

}  // namespace Rabit::Tool::LiveProtocol
