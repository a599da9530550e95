#pragma once

#include <rabit/RabitMessage.h>
#include <rabit/gateway/AirCost.h>
#include <rabit/gateway/GatewayConfig.h>
#include <rabit/idl/MessageType.h>
#include <rabit/transport/Transport.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "clocks/SourceClock.h"
#include "gateway.idl.h"
#include "mirrors/InstanceWriter.h"
#include "mirrors/PostCount.h"
#include "mirrors/RepeatPace.h"
#include "mirrors/StateVersion.h"

namespace Rabit
{

// Mirrors one local message to a topic: writes its newest value whenever it was posted, and a State again
// when others ask for it (RepeatPace); all no more often than the rule allows. Intermediate values may be
// skipped, as with a fetch. A type with a key has only the newest value's instance: the former one is
// disposed. Used by the gateway's thread only.
class TopicPublisher
{
public:
    using Duration = std::chrono::nanoseconds;

    // Time between failed attempts to write: without a network, a write fails at once.
    static constexpr Duration RetryGap = std::chrono::milliseconds(50);

    TopicPublisher(const PublishRule &rule, const MessageType &type, const std::string &node,
                   const SourceClock &source, TransportSession &session);

    const PublishRule &Rule() const { return _rule; }
    const MessageType &Type() const { return _type; }
    // The local copy, to be registered under the message's name; fetched by Service.
    const std::shared_ptr<RabitMessage> &Local() const { return _local; }
    // Call once it is registered; without it Service does nothing.
    void SetAttached();
    bool IsAttached() const { return _global != nullptr; }

    // The version of the State written last, which beats carry (StateVersion). None: nothing was written, the
    // last post can never be written, or it is telemetry.
    std::uint32_t Version() const { return _version; }
    // True if the last post that was to be written never can be: a bounded string in it is too long, for
    // instance. Others keep the value before it.
    bool IsUnwritable() const { return _everWritten && !_writtenTime; }
    // A node lacks the State of that version.
    void AskedFor(Duration now);
    // Fetches and writes a due value. Returns when to call again even if nothing is posted (Duration::max():
    // never).
    Duration Service(Duration now);

    // In place of Service, for a scheduler that chooses the next datagram. A message has one slot: a newer
    // post replaces the one that waits. The time of post goes with the value, so that its age is true however
    // long it waited.
    //
    // Takes the newest value, if there is a newer one.
    void Fetch();
    // When the fetched value is to be written; Duration::max(): there is none.
    Duration DueAt(Duration now) const;
    // Bytes on the air of the next datagram, with all its copies; at least 1. A sample of several datagrams
    // is sent one by one, and no newer value of this message is sent before its last.
    std::size_t NextBytes(const AirCost &cost) const;
    // Bytes on the air of the sample that was fetched last, all datagrams together; 0: it has no receiver.
    std::size_t SampleBytes(const AirCost &cost) const;
    // Writes one datagram of the due value.
    void WriteNext(Duration now);

    Gateway::PublicationStatus Status() const;
    std::uint64_t Written() const { return _written; }  // samples

private:
    using Way = WriteResult (InstanceWriter::*)(const RabitMessage &, std::int64_t);

    bool IsUnderWay() const { return _writer.HeldBytes() > 0; }
    void Write(Duration now, Way way);
    WriteResult WriteValue(Way way);
    void Written(Duration now);
    std::int64_t TimeOfPost() const;
    Duration ValueDueAt(Duration now) const;
    Duration NextGap() const;

    PublishRule _rule;
    const MessageType &_type;
    const SourceClock _source;
    std::shared_ptr<RabitMessage> _local;
    InstanceWriter _writer;
    PublishSubscribeMessage *_global = nullptr;  // once attached; lives as long as _local
    bool _pending = false;                       // fetched and not written yet
    bool _timedOut = false;                      // the last write, or the disposal after it
    bool _everWritten = false;
    std::int64_t _time = 0;                    // source time of the value fetched last
    std::optional<std::int64_t> _writtenTime;  // of the value written last; empty: it can never be written
    bool _isWhole = true;                      // it has gone to its last datagram, as far as is known
    std::uint32_t _version = StateVersion::None;
    RepeatPace _repeat;
    Duration _lastWrite{0};
    PostCount _posts;
    std::uint64_t _written = 0;
    std::uint64_t _failures = 0;
};

}  // namespace Rabit
