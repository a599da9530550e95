#pragma once

#include <rabit/gateway/GatewayConfig.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "air/AirCost.h"
#include "presence/Presence.h"
#include "queues/LinkDriver.h"
#include "types/KnownTexts.h"
#include "types/TypeAnswers.h"

namespace Rabit
{

// Hands out the IDL texts of types, and takes in those that this node has asked for (../types/README.md).
//
// Threads: the transport's threads leave parts that come in an inbox; all else is for the gateway's thread.
class TypeExchange
{
public:
    using Duration = std::chrono::nanoseconds;
    // A text that was asked for has come, and has that hash.
    using OnText = std::function<void(std::uint64_t definition, std::string text)>;

    // References must outlive the object, and the object the opened links. `wake` makes the gateway's thread
    // call TakeIn soon; called on any thread.
    TypeExchange(const GatewayConfig &config, Presence &presence, LinkDriver &links,
                 std::function<void()> wake, OnText onText);

    // Asks for a text. False: too many are lacking.
    bool Want(const TypeQuestions::Wanted &wanted, Duration now);
    // What the others ask, and what has come.
    void TakeIn(const Presence::Served &served, Duration now)
    {
        if (!served.TypesAsked.empty() || _lacks)
        {
            TakeInNews(served, now);
        }
    }

    // When a part is to be sent; empty: none is. What that takes, as bytes of the body of a sample; and sends
    // it.
    std::optional<Duration> Due() const { return _answers.Due(); }
    std::size_t NextBody(std::size_t most) const;
    void SendOne(std::size_t mostBody, Duration now);
    // Sends what is due, and returns when to be called again.
    Duration Service(Duration now);

    // Parts that nobody had asked for, and texts that had another hash.
    std::uint64_t Malformed() const;

private:
    // What the inbox holds at most: more than one answerer sends within a second.
    static constexpr std::size_t LargestInbox = 512 * 1024;

    void TakeInNews(const Presence::Served &served, Duration now);
    void OnFrame(std::string_view node, std::span<const std::uint8_t> frame);
    std::size_t LargestPart(std::size_t mostBody) const;

    Presence &_presence;
    LinkDriver &_links;
    const std::function<void()> _wake;
    const OnText _onText;
    const std::size_t _largestFrame;
    KnownTexts _texts;
    TypeAnswers _answers;

    std::atomic<bool> _lacks{false};  // something
    std::atomic<std::uint64_t> _dropped{0};
    std::mutex _mutex;
    std::vector<std::pair<std::string, std::vector<std::uint8_t>>> _inbox;  // guarded: nodes, frames
    std::size_t _inboxBytes = 0;                                            // guarded
};

}  // namespace Rabit
