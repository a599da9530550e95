#pragma once

#include <rabit/RabitHandlerThread.h>
#include <rabit/RabitWorkspace.h>
#include <rabit/gateway/ForeignRule.h>
#include <rabit/gateway/GatewayTap.h>
#include <rabit/idl/MessageType.h>
#include <rabit/transport/Transport.h>

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "foreign/ForeignMatch.h"
#include "foreign/ForeignWriters.h"
#include "gateway.idl.h"
#include "mirrors/LogThrottle.h"
#include "queues/AcceptedQueue.h"

namespace Rabit
{

// Reads one topic of foreign programs. The newest sample is posted on the transport's thread, without a lock
// held. Samples for a queue wait here until the gateway's thread has put them there. `handlers` calls the
// program's own handlers of the message or queue, so that a slow handler holds up neither thread. Public
// functions are for the gateway's thread alone.
class ForeignReader
{
public:
    using Duration = std::chrono::nanoseconds;

    // Between looks at the topic's writers.
    static constexpr Duration LookPeriod = std::chrono::milliseconds(250);

    // Rule, type, workspace and handlers must outlive the object. `wake` is called on any thread when Service
    // has work. Without `handlers`, handlers run on the two threads above. The tap, which may be null, is
    // told of each message that was put into the queue.
    ForeignReader(const ForeignRule &rule, const MessageType &type, ForeignMatch::Network network,
                  RabitWorkspace &workspace, std::function<void()> wake,
                  RabitHandlerThread *handlers = nullptr, std::shared_ptr<GatewayTap> tap = nullptr);
    ~ForeignReader();

    // Opens the reader; throws TransportError. The session must outlive the object.
    void Open(TransportSession &session, Duration now);
    // Returns the latest time of the next call.
    Duration Service(Duration now);
    // True if the state or the reason has changed since the last call.
    bool TakeChange();
    const Gateway::ForeignTopic &Status(Duration now);
    // Empty if there is no problem. A `certain` problem does not go away by waiting.
    std::optional<Gateway::Problem> Problem() const;

private:
    // The newest sample, as Judge and OnEnd need it.
    struct Shown
    {
        Duration PostedAt{0};
        KeyHash Key{};
        bool Ended = false;  // its instance was disposed, or its last writer has gone
    };

    // A sample that waits for room in the queue.
    struct Waiting
    {
        std::shared_ptr<RabitMessage> Message;
        std::size_t Bytes = 0;               // serialized, and once more for the tap
        std::vector<std::uint8_t> Sample{};  // for the tap, if there is one
    };

    bool IsQueue() const { return _rule.Each == ForeignRule::Delivery::Queue; }
    void MakeReader(const TopicQos &qos);
    void OnSample(SampleBytes bytes, const SampleInfo &info);
    void OnEnd(const SampleInfo &info);
    void Post(SampleBytes bytes, const SampleInfo &info, Duration now);
    void Keep(SampleBytes bytes);
    bool CountUndecodable(std::size_t size);
    Duration PostedAt(const SampleInfo &info, Duration now) const;
    void Deliver();
    void Look(Duration now);
    void Judge(Duration now);

    const ForeignRule &_rule;
    const MessageType &_type;
    const ForeignMatch::Network _network;
    RabitWorkspace &_workspace;
    const std::function<void()> _wake;
    RabitHandlerThread *const _handlers;
    const std::shared_ptr<GatewayTap> _tap;
    std::unique_ptr<RabitMessage> _scratch;  // of the transport's handler, which runs once at a time
    std::shared_ptr<PublishSubscribeMessage> _global;  // unchanged once the reader is open
    std::string _localProblem;                         // likewise
    AcceptedQueue _queue;                              // for the gateway's thread, except Decode

    mutable std::mutex _mutex;
    ForeignWriters _writers;  // guarded by _mutex, as all down to the next empty line
    std::deque<Waiting> _waiting;
    std::size_t _waitingBytes = 0;
    bool _wasDropped = false;  // the newest sample, because there was no room
    std::optional<Shown> _shown;
    std::uint64_t _undecodable = 0;
    std::uint64_t _undecodableInARow = 0;
    std::uint64_t _overtaken = 0;
    std::uint64_t _ofNodes = 0;
    std::uint64_t _overflowed = 0;
    std::uint64_t _samples = 0;
    LogThrottle _log;

    TransportSession *_session = nullptr;
    TopicQos _qos;
    std::vector<RemoteEndpoint> _found;  // the programs' writers of the topic
    std::size_t _matching = 0;           // those of _found that match
    std::string _whyNone;
    std::string _shortfall;  // of the other programs; empty while _matching is 0
    bool _isMismatch = false;
    std::optional<Duration> _nextLook;
    bool _changed = true;
    Gateway::ForeignTopic _status;
    std::unique_ptr<TransportReader> _reader;
};

}  // namespace Rabit
