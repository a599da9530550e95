#pragma once

#include <rabit/RabitQueueReceipt.h>
#include <rabit/RabitWorkspace.h>
#include <rabit/gateway/GatewayConfig.h>
#include <rabit/gateway/GatewayTap.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "backfill.idl.h"

namespace Rabit::Backfill
{

// The queue of questions and answers, which is that of the manager of this name.
inline constexpr const char *QueueName = "Backfill";
// Messages in it. While they wait, senders wait, too.
inline constexpr int QueueCapacity = 64;
// A message that waits for longer is not sent any more: by then the other end takes it for lost
// (Requester::Patience, FileFetch::Patience).
inline constexpr std::chrono::minutes Expiry(2);

// Questions and answers that have come, with the nodes that sent them; a local queue does not tell these.
// Also what else a gateway reports. Thread-safe.
class Mail final : public GatewayTap
{
public:
    // Adds the queue, its class and the tap to the configuration of a gateway that is made later. The former
    // tap gets all that is not about this queue. Throws ConfigError if `accept` names the queue already.
    static std::shared_ptr<Mail> For(GatewayConfig &config);

    explicit Mail(std::shared_ptr<GatewayTap> other) : _other(std::move(other)) {}

    struct Letter
    {
        std::string Node;
        std::optional<Question> Asked;  // one of both
        std::optional<Answer> Answered;
    };
    // Letters that came since the last call. Take the messages out of the queue with them. Those that do not
    // decode, and those beyond a bound, are dropped: a question without an answer is asked again.
    std::vector<Letter> Take();

    // Set these before the gateway starts. Called on any thread.
    std::function<void(const MirroredSample &)> OnMirrored;
    std::function<std::vector<Gateway::Problem>()> OwnProblems;

    // The present incarnation of this node; 0: not known yet.
    std::uint64_t Incarnation() const;
    // The difference to add to the source time of that incarnation of a node to get the monotonic time here.
    // Of an incarnation that was never heard, that of another one: wall clocks go on. Empty: neither is
    // known.
    std::optional<std::chrono::nanoseconds> SourceToLocal(const std::string &node,
                                                          std::uint64_t incarnation) const;

    void Sent(const QueueMessage &message) override;
    void Refused(const QueueMessage &message, std::string_view reason) override;
    void Settled(std::string_view node, std::string_view queue, std::uint64_t id,
                 QueueOutcome outcome) override;
    void Received(const QueueMessage &message) override;
    void Mirrored(const MirroredSample &sample) override;
    void Clocks(std::uint64_t incarnation, std::chrono::nanoseconds sourceAhead,
                const std::vector<PeerClock> &peers) override;
    std::vector<Gateway::Problem> Problems() override;

private:
    // Letters that wait: as many as the queue holds, and those that are under way into it.
    static constexpr std::size_t MostLetters = 4 * QueueCapacity;
    // Clocks that are remembered.
    static constexpr std::size_t MostClocks = 4096;

    const std::shared_ptr<GatewayTap> _other;  // may be null
    mutable std::mutex _mutex;
    std::vector<Letter> _letters;
    std::uint64_t _incarnation = 0;
    std::map<std::pair<std::string, std::uint64_t>, std::chrono::nanoseconds> _clocks;
};

}  // namespace Rabit::Backfill
