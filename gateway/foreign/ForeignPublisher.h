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
#include "foreign/ForeignMatch.h"
#include "gateway.idl.h"
#include "mirrors/InstanceWriter.h"

namespace Rabit
{

// Writes one local message to a topic of foreign programs: the newest value after each post, at most at the
// rule's rate. Intermediate values may be skipped, as with a fetch. Gateway's thread only.
class ForeignPublisher
{
public:
    using Duration = std::chrono::nanoseconds;

    // RetryGap: between attempts while the network takes no sample. LookPeriod: between looks at the topic's
    // readers.
    static constexpr Duration RetryGap = std::chrono::milliseconds(50);
    static constexpr Duration LookPeriod = std::chrono::milliseconds(250);

    // Opens the writer; throws TransportError. All arguments must outlive the object.
    ForeignPublisher(const ForeignRule &rule, const MessageType &type, ForeignMatch::Network network,
                     const SourceClock &source, TransportSession &session);

    // Register this message under rule.Local, and have its posts wake the gateway.
    const std::shared_ptr<RabitMessage> &Local() const { return _local; }
    void SetAttached() { _attached = true; }
    const ForeignRule &Rule() const { return _rule; }

    // Returns the latest time of the next call.
    Duration Service(Duration now);
    bool TakeChange();
    const Gateway::ForeignTopic &Status();
    std::optional<Gateway::Problem> Problem() const;

private:
    void Write(Duration now);
    void Look(Duration now);
    Duration Gap() const;

    const ForeignRule &_rule;
    const ForeignMatch::Network _network;
    const SourceClock &_source;
    TransportSession &_session;
    const TopicQos _qos;
    InstanceWriter _writer;
    const std::shared_ptr<RabitMessage> _local;
    bool _attached = false;
    bool _pending = false;  // posted, and not yet written
    std::optional<Duration> _lastWrite;
    bool _timedOut = false;
    std::optional<Duration> _nextLook;
    bool _isMismatch = false;
    bool _changed = true;
    Gateway::ForeignTopic _status;
};

}  // namespace Rabit
