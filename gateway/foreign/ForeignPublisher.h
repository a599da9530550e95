#pragma once

#include <rabit/RabitMessage.h>
#include <rabit/gateway/ForeignRule.h>
#include <rabit/idl/MessageType.h>
#include <rabit/transport/Transport.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "clocks/SourceClock.h"
#include "gateway.idl.h"
#include "mirrors/InstanceWriter.h"

namespace Rabit
{

// Writes one local message to a topic of programs that are no nodes: its newest value whenever it was posted,
// no more often than the rule allows; intermediate values may be skipped, as with a fetch. Gateway's thread
// only.
class ForeignPublisher
{
public:
    using Duration = std::chrono::nanoseconds;

    // Between attempts of which the network takes none, and between looks at who reads the topic.
    static constexpr Duration RetryGap = std::chrono::milliseconds(50);
    static constexpr Duration LookPeriod = std::chrono::milliseconds(250);

    // Opens the writer; throws TransportError. All that is given must outlive the object.
    ForeignPublisher(const ForeignRule &rule, const MessageType &type, int domain, const SourceClock &source,
                     TransportSession &session);

    // Register this under rule.Local, and have its posts wake the gateway.
    const std::shared_ptr<RabitMessage> &Local() const { return _local; }
    void SetAttached() { _attached = true; }
    const ForeignRule &Rule() const { return _rule; }

    // Returns when to be called again at the latest.
    Duration Service(Duration now);
    bool TakeChange();
    const Gateway::ForeignTopic &Status();
    std::optional<Gateway::Problem> Problem() const;

private:
    void Write(Duration now);
    void Look(Duration now);
    Duration Gap() const;

    const ForeignRule &_rule;
    const int _domain;
    const SourceClock &_source;
    TransportSession &_session;
    const TopicQos _qos;
    InstanceWriter _writer;
    const std::shared_ptr<RabitMessage> _local;
    bool _attached = false;
    bool _pending = false;  // posted and not written
    std::optional<Duration> _lastWrite;
    bool _timedOut = false;
    std::optional<Duration> _nextLook;
    bool _isMismatch = false;
    bool _changed = true;
    Gateway::ForeignTopic _status;
};

}  // namespace Rabit
