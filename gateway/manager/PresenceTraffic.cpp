#include <rabit/gateway/PresenceTraffic.h>

#include <rabit/gateway/AirCost.h>

#include <algorithm>

#include "manager/TransportSettingsOf.h"
#include "presence/BeatRate.h"
#include "wire/BeatFormat.h"

namespace Rabit
{

PresenceTraffic PresenceTrafficOf(const GatewayConfig &config, std::size_t copies)
{
    const auto states = static_cast<std::size_t>(std::count_if(config.Publish.begin(), config.Publish.end(),
                                                               [](const PublishRule &rule)
                                                               { return rule.Qos == QosProfile::State; }));
    const std::size_t body =
        states == 0 ? BeatFormat::Empty
                    : BeatFormat::WithNews + BeatFormat::State * std::min(states, BeatFormat::MostStates);
    PresenceTraffic traffic;
    traffic.BeatBytes = AirCost(config.MaxDatagram).Of(body);
    traffic.BeatPeriod =
        BeatRate::PeriodOf(static_cast<double>(traffic.BeatBytes) * static_cast<double>(copies),
                           config.Radio.Budget, config.Radio.SlowestBeat);
    traffic.AnnouncementPeriod = TransportSettingsOf(config, 0).AnnouncementPeriod;
    return traffic;
}

}  // namespace Rabit
