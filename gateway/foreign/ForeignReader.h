#pragma once

#include <rabit/RabitHandlerThread.h>
#include <rabit/RabitWorkspace.h>
#include <rabit/gateway/ForeignRule.h>
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

#include "foreign/ForeignWriters.h"
#include "gateway.idl.h"
#include "mirrors/LogThrottle.h"
#include "queues/AcceptedQueue.h"

namespace Rabit
{

// Reads one topic of programs that are no nodes. The newest sample is posted on the transport's thread,
// without a lock held; samples for a queue wait here until the gateway's thread has put them there. The
// program's own handlers of either are called by `handlers`, so that a slow one holds up neither thread. The
// gateway's thread alone calls what is public.
class ForeignReader
{
public:
    using Duration = std::chrono::nanoseconds;

    // Between looks at who writes the topic.
    static constexpr Duration LookPeriod = std::chrono::milliseconds(250);

    // Rule, type, workspace and handlers must outlive the object. `wake` is called when there is something to
    // do, on any thread. Without `handlers` all handlers are called on the two threads above.
    ForeignReader(const ForeignRule &rule, const MessageType &type, int domain, RabitWorkspace &workspace,
                  std::function<void()> wake, RabitHandlerThread *handlers = nullptr);
    ~ForeignReader();

    // Opens the reader; throws TransportError. The session must outlive the object.
    void Open(TransportSession &session, Duration now);
    // Returns when to be called again at the latest.
    Duration Service(Duration now);
    // Whether the state or the reason has changed since this was asked last.
    bool TakeChange();
    const Gateway::ForeignTopic &Status(Duration now);
    // Empty if there is none. Certain ones do not go with patience.
    std::optional<Gateway::Problem> Problem() const;

private:
    // What a sample is worth once it is decoded.
    struct Shown
    {
        Duration PostedAt{0};
        KeyHash Key{};
        bool Ended = false;  // its instance was disposed, or its last writer has gone
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
    const int _domain;
    RabitWorkspace &_workspace;
    const std::function<void()> _wake;
    RabitHandlerThread *const _handlers;
    std::unique_ptr<RabitMessage> _scratch;            // of the handler, of which there is one at a time
    std::shared_ptr<PublishSubscribeMessage> _global;  // unchanged once the reader is open
    std::string _localProblem;                         // likewise
    AcceptedQueue _queue;                              // of the gateway's thread, but for Decode

    mutable std::mutex _mutex;
    ForeignWriters _writers;  // guarded, as all down to the next empty line
    std::deque<std::shared_ptr<RabitMessage>> _waiting;
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
    std::size_t _matching = 0;           // of these
    std::string _whyNone;
    bool _isMismatch = false;
    std::optional<Duration> _nextLook;
    bool _changed = true;
    Gateway::ForeignTopic _status;
    std::unique_ptr<TransportReader> _reader;
};

}  // namespace Rabit
