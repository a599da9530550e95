#include "RealLife.h"

#include <rabit/RabitLog.h>
#include <rabit/RabitReactor.h>
#include <rabit/gateway/GatewayManager.h>
#include <rabit/recording/RecorderManager.h>
#include <rabit/transport/TransportFactory.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <utility>

#include "RecordedPosts.h"
#include "recording/replay/PostTimes.h"

namespace Rabit::WhatIf
{
namespace
{

using std::chrono::milliseconds;
using std::chrono::nanoseconds;

// Longest sleep while nothing is due.
constexpr milliseconds LongestSleep{1000};

// Posts and sends what one life did, when it is due.
class Pilot final : public RabitManager
{
public:
    Pilot(Recording &recording, const RecordedLife &life, const GatewayConfig &config)
        : RabitManager("FlightPilot"),
          _recording(recording),
          _node(life.Node),
          _begin(std::max(life.Begin, recording.Begin())),
          _end(life.End),
          _times(recording.Plan().Streams.size()),
          _posts(*RabitWorkspace::GetWorkspace(), config)
    {
    }

    void Startup() final
    {
        _recording.Messages().Begin(_begin);
        _startedAt = Now();
        _next = NextOfNode();
    }
    void ExecuteUnitOfWork() final
    {
        while (_next && DueAt(*_next) <= Now())
        {
            _posts.Play(*_next, _recording.Plan().Streams[_next->Stream], _times);
            _next = NextOfNode();
        }
        const nanoseconds left = _next ? DueAt(*_next) - Now() : nanoseconds(LongestSleep);
        const auto sleep = std::chrono::ceil<milliseconds>(left);
        SetWakeupTimeDelayMSec(
            static_cast<int>(std::clamp(sleep, milliseconds(1), milliseconds(LongestSleep)).count()));
    }

private:
    static nanoseconds Now() { return RabitWorkspace::GetWorkspace()->GetClock().Now().Monotonic; }
    nanoseconds DueAt(const Replay::ReplayItem &item) const
    {
        return _startedAt +
               nanoseconds(static_cast<std::int64_t>(item.LogTime - std::min(item.LogTime, _begin)));
    }
    std::optional<Replay::ReplayItem> NextOfNode()
    {
        auto item = _recording.Messages().Next();
        while (item && _recording.Plan().Streams[item->Stream].Node != _node)
        {
            item = _recording.Messages().Next();
        }
        return item && item->LogTime <= _end ? std::move(item) : std::nullopt;
    }

    Recording &_recording;
    const std::string _node;
    const Time _begin;
    const Time _end;
    Replay::PostTimes _times;
    RecordedPosts _posts;
    nanoseconds _startedAt{0};
    std::optional<Replay::ReplayItem> _next;
};

const RecordedLife &LifeOf(const Recording &recording, const RealLifeSettings &settings)
{
    int number = 0;
    for (const RecordedLife &life : recording.Lives())
    {
        if (life.Node == settings.Node && ++number == settings.Life)
        {
            return life;
        }
    }
    throw std::runtime_error("the recording has no life " + std::to_string(settings.Life) + " of " +
                             settings.Node);
}

}  // namespace

void FlyLife(Recording &recording, const RealLifeSettings &settings)
{
    const RecordedLife &life = LifeOf(recording, settings);
    GatewayConfig config = life.Config;
    UseInterfaces(settings.Interfaces, config);
    if (!settings.Record.empty())
    {
        config.Record.emplace().Folder = settings.Record;
    }
    if (settings.Budget)
    {
        config.Radio.Budget = *settings.Budget > 0 ? settings.Budget : std::nullopt;
    }
    RabitLog::SetName(config.Node);
    RabitReactor reactor;
    reactor.AddManager(std::make_unique<Pilot>(recording, life, config));
    for (const AcceptRule &rule : config.Accept)
    {
        reactor.AddManager(std::make_unique<QueueTaker>(rule.Queue));
    }
    // The recorder comes before the gateway, which tells it of queue messages.
    if (config.Record)
    {
        reactor.AddManager(std::make_unique<RecorderManager>(config));
    }
    reactor.AddManager(std::make_unique<GatewayManager>(config, TransportsOf(config, MakeTransport)));
    reactor.Run();  // until SIGINT or SIGTERM
}

}  // namespace Rabit::WhatIf
