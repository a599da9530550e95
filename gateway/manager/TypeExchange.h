#pragma once

#include <rabit/gateway/AirCost.h>
#include <rabit/gateway/GatewayConfig.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "presence/Presence.h"
#include "queues/LinkDriver.h"
#include "types/KnownTexts.h"
#include "types/TypeAnswers.h"
#include "types/TypeQuestions.h"
#include "wire/NodeReports.h"

namespace Rabit
{

// Sends the IDL texts of types and the reports of this node on request, and collects those that this node has
// requested (../types/README.md).
//
// Threads: the transport's threads put arriving parts into an inbox; all else is for the gateway's thread.
class TypeExchange
{
public:
    using Duration = std::chrono::nanoseconds;
    // A requested text has come, from that node and with that hash, or a report of that name.
    using OnText =
        std::function<void(const std::string &node, std::uint64_t definition, TypeQuestions::Answer answer)>;
    // Returns a report of this node; empty if there is nothing to report.
    using ReportOf = std::function<std::optional<std::string>(NodeReports::Name name)>;

    // One for each path. References must outlive the object, and the object the opened links. `wake` makes
    // the gateway's thread call TakeIn soon; called on any thread.
    TypeExchange(const GatewayConfig &config, Presence &presence, LinkDriver &links, std::size_t path,
                 std::function<void()> wake, OnText onText, ReportOf reportOf);

    // Requests a text. False: too many are lacking.
    bool Want(const TypeQuestions::Wanted &wanted, Duration now);
    // Processes the questions of other nodes, and the parts that have come.
    void TakeIn(const Presence::Served &served, Duration now)
    {
        if (!served.TypesAsked.empty() || _lacks)
        {
            TakeInNews(served, now);
        }
    }

    // Due: when a part is to be sent; empty: none is. NextBody: its size, in bytes of the body of a sample.
    // SendOne sends it.
    std::optional<Duration> Due() const { return _answers.Due(); }
    std::size_t NextBody(std::size_t most) const;
    void SendOne(std::size_t mostBody, Duration now);
    // Sends the due parts, and returns when to call again.
    Duration Service(Duration now);

    // Number of parts that were not requested, and of texts with another hash.
    std::uint64_t Malformed() const;

private:
    // Largest contents of the inbox in bytes: more than one answering node sends within a second.
    static constexpr std::size_t LargestInbox = 512 * 1024;

    void TakeInNews(const Presence::Served &served, Duration now);
    void OnFrame(std::string_view node, std::span<const std::uint8_t> frame);
    std::shared_ptr<const std::string> TextOf(std::uint64_t definition);
    std::size_t LargestPart(std::size_t mostBody) const;

    Presence &_presence;
    LinkDriver &_links;
    const std::size_t _path;
    const std::function<void()> _wake;
    const OnText _onText;
    const ReportOf _reportOf;
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
