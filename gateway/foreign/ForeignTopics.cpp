#include "foreign/ForeignTopics.h"

#include <rabit/idl/MessageTypeRegistry.h>

#include <algorithm>

namespace Rabit
{

void ForeignTopics::Open(TransportSession &session, RabitManager &manager, Duration now)
{
    const GatewayConfig path = PathConfigsOf(_config).front();
    const ForeignMatch::Network network{_config.Domain, path.Interfaces,
                                        path.Paths.empty() ? "" : path.Paths.front().Name};
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
        ForeignPublisher &publisher = _publishers.emplace_back(rule, type, network, _source, session);
        if (manager.AddPublishSubscribeMessage(rule.Local, publisher.Local()))
        {
            manager.WakeUpManagerOnMessagePost(publisher.Local());
            publisher.SetAttached();
        }
    }
}

void ForeignTopics::Close()
{
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
        add(publisher.Status(), publisher.Problem());
    }
}

}  // namespace Rabit
