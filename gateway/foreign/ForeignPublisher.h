#pragma once

#include <rabit/RabitMessage.h>
#include <rabit/RabitWorkspace.h>
#include <rabit/gateway/ForeignRule.h>
#include <rabit/idl/MessageType.h>
#include <rabit/transport/Transport.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "air/AirCost.h"
#include "clocks/SourceClock.h"
#include "foreign/ForeignMatch.h"
#include "foreign/ForeignOutbox.h"
#include "gateway.idl.h"
#include "mirrors/InstanceWriter.h"
#include "mirrors/PostCount.h"

namespace Rabit
{

// Writes to a topic of foreign programs, at most at the rule's rate: the newest value of one local message
// after each post, or each message of a local queue. A scheduler may choose the next datagram, as with
// TopicPublisher. Gateway's thread only.
class ForeignPublisher
{
public:
    using Duration = std::chrono::nanoseconds;

    // RetryGap: between attempts while the network takes no sample. LookPeriod: between looks at the topic's
    // readers.
    static constexpr Duration RetryGap = std::chrono::milliseconds(50);
    static constexpr Duration LookPeriod = std::chrono::milliseconds(250);
    // Samples that WriteDue writes at most, so that beats are not held up by a full queue.
    static constexpr int MostAtOnce = 100;

    // Opens the writer; throws TransportError. The references must outlive the object. `outbox`: of a queue;
    // null: a message is written.
    ForeignPublisher(const ForeignRule &rule, const MessageType &type, ForeignMatch::Network network,
                     const RabitWorkspace &workspace, const SourceClock &source, TransportSession &session,
                     const AirCost &cost, std::shared_ptr<ForeignOutbox> outbox = nullptr);

    // Register this message under rule.Local, and have its posts wake the gateway. Null for a queue.
    const std::shared_ptr<RabitMessage> &Local() const { return _local; }
    void SetAttached();
    const ForeignRule &Rule() const { return _rule; }

    // Looks at the topic's readers. Returns the latest time of the next call.
    Duration Service(Duration now);

    // Writes what is due. Returns when to call again; Duration::max(): when there is something new.
    Duration WriteDue(Duration now);

    // In place of WriteDue, for a scheduler that chooses the next datagram.
    //
    // Takes the newest value of the message, if there is a newer one.
    void Fetch();
    // When the next sample is to be written; Duration::max(): there is none.
    Duration DueAt(Duration now) const;
    // Bytes on the air of the next datagram, with all its copies; at least 1.
    std::size_t NextBytes() const;
    // Writes one datagram of the next sample.
    void WriteNext(Duration now);

    // Bytes on the air of all samples written.
    std::uint64_t SentBytes() const { return _sentBytes; }

    bool TakeChange();
    const Gateway::ForeignTopic &Status();
    std::optional<Gateway::Problem> Problem(Duration now) const;

private:
    enum class Way
    {
        Whole,
        FirstDatagram
    };

    bool HasNext() const { return _outbox ? _outbox->Front() != nullptr : _pending; }
    bool IsUnread() const;
    std::size_t NextSize() const;
    std::size_t Copies() const;
    void Write(Duration now, Way way);
    WriteResult WriteMessage(Way way);
    WriteResult WriteValue(Way way);
    template <typename Sample>
    WriteResult WriteSample(const Sample &sample, std::size_t size, std::int64_t sourceTime, Way way);
    void Look(Duration now);
    std::string LocalProblem() const;
    Duration Gap() const;

    const ForeignRule &_rule;
    const MessageType &_type;
    const ForeignMatch::Network _network;
    const RabitWorkspace &_workspace;
    const SourceClock &_source;
    TransportSession &_session;
    const TopicQos _qos;
    const AirCost _cost;
    InstanceWriter _writer;
    const std::shared_ptr<ForeignOutbox> _outbox;
    const std::shared_ptr<RabitMessage> _local;
    PublishSubscribeMessage *_global = nullptr;  // once attached; lives as long as _local
    bool _pending = false;                       // posted, and not yet written
    PostCount _posts;
    std::optional<Duration> _lastWrite;
    bool _timedOut = false;
    std::uint64_t _sentBytes = 0;
    std::optional<Duration> _nextLook;
    bool _isMismatch = false;
    std::string _localProblem;
    bool _changed = true;
    Gateway::ForeignTopic _status;
};

}  // namespace Rabit
