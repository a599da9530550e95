#pragma once

#include <rabit/RabitHandlerThread.h>
#include <rabit/RabitManager.h>
#include <rabit/gateway/GatewayConfig.h>
#include <rabit/transport/Transport.h>

#include <chrono>
#include <deque>
#include <memory>
#include <vector>

#include "clocks/SourceClock.h"
#include "foreign/ForeignPublisher.h"
#include "foreign/ForeignQueues.h"
#include "foreign/ForeignReader.h"
#include "gateway.idl.h"

namespace Rabit
{

// All topics of foreign programs that this node reads or writes. Gateway's thread only.
class ForeignTopics
{
public:
    using Duration = std::chrono::nanoseconds;

    // The configuration, the clock, the workspace of the manager and the handlers must outlive the object.
    // `handlers` may be null: see ForeignReader.
    ForeignTopics(const GatewayConfig &config, const SourceClock &source, RabitHandlerThread *handlers)
        : _config(config), _source(source), _handlers(handlers)
    {
    }

    // Throws TransportError. Posts of the messages that are written wake the manager, and messages for queues
    // that are written.
    void Open(TransportSession &session, RabitManager &manager, Duration now);
    void Close();
    // Writes nothing, since the schedule of the session's path serves Publishers. Returns the latest time of
    // the next call.
    Duration Service(Duration now) { return IsEmpty() ? Duration::max() : ServiceAll(now); }
    // True if a state or a reason has changed since the last call.
    bool TakeChange() { return !IsEmpty() && TakeAnyChange(); }
    // Adds a row for each topic, and their problems.
    void Report(Duration now, Gateway::Fleet &fleet);
    // Unchanged between Open and Close.
    std::deque<ForeignPublisher> &Publishers() { return _publishers; }

private:
    bool IsEmpty() const { return _readers.empty() && _publishers.empty(); }
    Duration ServiceAll(Duration now);
    bool TakeAnyChange();
    void AddPublisher(const ForeignRule &rule, const MessageType &type, const ForeignMatch::Network &network,
                      TransportSession &session, RabitManager &manager);

    const GatewayConfig &_config;
    const SourceClock &_source;
    RabitHandlerThread *const _handlers;
    std::deque<ForeignReader> _readers;
    std::deque<ForeignPublisher> _publishers;
    std::vector<std::shared_ptr<ForeignOutbox>> _outboxes;
    RabitWorkspace *_workspace = nullptr;  // while it forwards messages to _outboxes
};

}  // namespace Rabit
