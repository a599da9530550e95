#pragma once

#include <rabit/gateway/GatewayConfig.h>
#include <rabit/gateway/GatewayTap.h>

#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "recording/RecordingTarget.h"

namespace Rabit
{

// Records what the gateway reports: queue messages, their outcomes, and clocks. Reports lost messages to
// the gateway.
class QueueStreams final : public GatewayTap
{
public:
    // A bound, since names come from the network. Messages that would need more streams are counted as
    // lost.
    static constexpr std::size_t MostStreams = 4096;
    // Rows in Gateway/Fleet. All further topics share one more row.
    static constexpr std::size_t MostProblems = 20;

    QueueStreams(std::shared_ptr<RecordingTarget> target, const RecordSettings &settings);

    void Sent(const QueueMessage &message) override;
    void Refused(const QueueMessage &message, std::string_view reason) override;
    void Settled(std::string_view node, std::string_view queue, std::uint64_t id,
                 QueueOutcome outcome) override;
    void Received(const QueueMessage &message) override;
    void Mirrored(const MirroredSample &) override {}  // MessageTaps records the posts
    void Clocks(std::uint64_t incarnation, std::chrono::nanoseconds sourceAhead,
                const std::vector<PeerClock> &peers) override;
    std::vector<Gateway::Problem> Problems() override;

private:
    void Record(const char *what, const QueueMessage &message);
    std::uint32_t StreamOf(const char *what, const QueueMessage &message);
    void TellOutcome(std::string_view node, std::string_view queue, std::uint64_t id,
                     const std::string &outcome, std::string_view reason);

    const std::shared_ptr<RecordingTarget> _target;
    const RecordSettings _settings;
    const std::uint32_t _outcomes;
    const std::uint32_t _clocks;
    const std::uint32_t _others;
    std::uint64_t _incarnation = 0;  // of this node; used on the gateway's thread
    std::mutex _mutex;
    std::map<std::string, std::uint32_t> _streams;  // by topic
};

}  // namespace Rabit
