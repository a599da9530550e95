#pragma once

#include <rabit/RabitMessage.h>
#include <rabit/gateway/GatewayConfig.h>
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
#include "gateway.idl.h"
#include "mirrors/InstanceWriter.h"
#include "mirrors/RepeatPace.h"
#include "mirrors/StateVersion.h"

namespace Rabit
{

// Mirrors one local message to a topic: writes its newest value whenever it was posted, and a State again
// when others ask for it (RepeatPace); all no more often than the rule allows. Intermediate values may be
// skipped, as with a fetch. Of a type with a key the newest value's instance alone is there: the former one
// is disposed. Used by the gateway's thread only.
class TopicPublisher
{
public:
    using Duration = std::chrono::nanoseconds;

    // Between attempts of which the network takes none: while there is none, a write ends at once.
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

    // Of the State that was written last, for the beats to tell (StateVersion). None: nothing was, or what
    // was posted last can never be written, or it is telemetry.
    std::uint32_t Version() const { return _version; }
    // Somebody lacks the State of that version.
    void AskedFor(Duration now);
    // Fetches and writes what is due. Returns when to call again even if nothing is posted (Duration::max():
    // never).
    Duration Service(Duration now);

    // In place of Service, for a scheduler that decides what goes out next. A message has one slot: a newer
    // post replaces the one that waits, whose time of post goes with it, so that its age is true however long
    // it waited.
    //
    // Takes the newest value, if there is a newer one.
    void Fetch();
    // When there is something to write, of what was fetched; Duration::max(): nothing.
    Duration DueAt(Duration now) const;
    // What its next datagram takes on the air, all its copies; at least 1. A sample that takes several ones
    // goes one by one, and nothing else of this message goes before its last.
    std::size_t NextBytes(const AirCost &cost) const;
    // Bytes on the air of the sample that was fetched last, all datagrams together; 0: nobody gets it.
    std::size_t SampleBytes(const AirCost &cost) const;
    // Writes what is due, one datagram.
    void WriteNext(Duration now);

    Gateway::PublicationStatus Status() const;

private:
    using Way = WriteResult (InstanceWriter::*)(const RabitMessage &, std::int64_t);

    bool IsUnderWay() const { return _writer.HeldBytes() > 0; }
    void Write(Duration now, Way way);
    WriteResult WriteValue(Way way);
    void Written(Duration now);
    std::int64_t TimeOfPost() const;
    Duration ValueDueAt(Duration now) const;
    Duration MinimumGap() const;
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
    std::int64_t _time = 0;                    // source time of what was fetched last
    std::optional<std::int64_t> _writtenTime;  // of what was written last; empty: that can never be written
    bool _isWhole = true;                      // it has gone to its last datagram, as far as is known
    std::uint32_t _version = StateVersion::None;
    RepeatPace _repeat;
    Duration _lastWrite{0};
    std::uint64_t _offered = 0;  // posts, of this name, since it was attached
    std::uint64_t _postsBefore = 0;
    std::uint64_t _taken = 0;  // of them, values that were written or never can be
    std::uint64_t _written = 0;
    std::uint64_t _failures = 0;
};

}  // namespace Rabit
