#include "foreign/ForeignTopics.h"

#include <rabit/RabitLog.h>
#include <rabit/idl/MessageTypeRegistry.h>

#include <algorithm>
#include <string>
#include <utility>

#include "names/ForeignNames.h"

namespace Rabit
{
namespace
{

// No gateway has such a name.
std::string ForwarderOf(const GatewayConfig &config)
{
    return config.Name + "/foreign";
}

}  // namespace

void ForeignTopics::Open(TransportSession &session, RabitManager &manager, Duration now)
{
    const GatewayConfig path = PathConfigsOf(_config).front();
    ForeignMatch::Network network{_config.Domain, path.Interfaces,
                                  path.Paths.empty() ? "" : path.Paths.front().Name};
    for (const ForeignRule &rule : _config.Foreign)
    {
        network.Own.push_back(WireTopicOf(rule));
    }
    for (const PublishRule &rule : _config.Publish)
    {
        network.Own.push_back(rule.Message);
    }
    for (const ForeignRule &rule : _config.Foreign)
    {
        const MessageType &type = *MessageTypeRegistry::Find(rule.Type);
        if (rule.Way == ForeignRule::Direction::Subscribe)
        {
            _readers.emplace_back(rule, type, network, manager.GetWorkspace(), manager.WakeUpHandler(),
                                  _handlers, _config.Tap);
            _readers.back().Open(session, now);
            continue;
        }
        AddPublisher(rule, type, network, session, manager);
    }
    if (!_outboxes.empty())
    {
        const auto queues = std::make_shared<ForeignQueues>();
        for (const std::shared_ptr<ForeignOutbox> &outbox : _outboxes)
        {
            queues->Add(outbox->Queue(), outbox);
        }
        _workspace = &manager.GetWorkspace();
        _workspace->AddQueueForwarder(ForwarderOf(_config), queues);
    }
}

void ForeignTopics::AddPublisher(const ForeignRule &rule, const MessageType &type,
                                 const ForeignMatch::Network &network, TransportSession &session,
                                 RabitManager &manager)
{
    RabitWorkspace &workspace = manager.GetWorkspace();
    const AirCost cost(_config.MaxDatagram);
    if (rule.Each == ForeignRule::Delivery::Queue)
    {
        const auto outbox =
            std::make_shared<ForeignOutbox>(rule, type, workspace.GetClock(), _source, _outboxes.size(),
                                            manager.WakeUpHandler(), _handlers, _config.Tap);
        _publishers.emplace_back(rule, type, network, workspace, _source, session, cost, outbox);
        _outboxes.push_back(outbox);
        return;
    }
    ForeignPublisher &publisher =
        _publishers.emplace_back(rule, type, network, workspace, _source, session, cost);
    if (manager.AddPublishSubscribeMessage(rule.Local, publisher.Local()))
    {
        manager.WakeUpManagerOnMessagePost(publisher.Local());
        publisher.SetAttached();
    }
}

void ForeignTopics::Close()
{
    if (RabitWorkspace *const workspace = std::exchange(_workspace, nullptr))
    {
        workspace->RemoveQueueForwarder(ForwarderOf(_config));
    }
    for (const std::shared_ptr<ForeignOutbox> &outbox : std::exchange(_outboxes, {}))
    {
        if (const std::size_t left = outbox->Close(); left > 0)
        {
            RabitLog::Write(RabitLogLevel::Warning,
                            "gateway: " + std::to_string(left) + " messages of the queue `" +
                                outbox->Queue() +
                                "` were accepted for a foreign topic and not sent before the end");
        }
    }
    _readers.clear();
    _publishers.clear();
}

ForeignTopics::Duration ForeignTopics::ServiceAll(Duration now)
{
    Duration next = Duration::max();
    for (ForeignReader &reader : _readers)
    {
        next = std::min(next, reader.Service(now));
    }
    for (ForeignPublisher &publisher : _publishers)
    {
        next = std::min(next, publisher.Service(now));
    }
    return next;
}

bool ForeignTopics::TakeAnyChange()
{
    bool changed = false;
    for (ForeignReader &reader : _readers)
    {
        changed |= reader.TakeChange();
    }
    for (ForeignPublisher &publisher : _publishers)
    {
        changed |= publisher.TakeChange();
    }
    return changed;
}

void ForeignTopics::Report(Duration now, Gateway::Fleet &fleet)
{
    const auto add =
        [&fleet](const Gateway::ForeignTopic &status, const std::optional<Gateway::Problem> &problem)
    {
        fleet.foreign.push_back(status);
        if (problem)
        {
            fleet.problems.push_back(*problem);
        }
    };
    for (ForeignReader &reader : _readers)
    {
        add(reader.Status(now), reader.Problem());
    }
    for (ForeignPublisher &publisher : _publishers)
    {
        add(publisher.Status(), publisher.Problem(now));
    }
}

}  // namespace Rabit
