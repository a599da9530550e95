#include "manager/TransportSettingsOf.h"

#include <rabit/RabitLog.h>
#include <rabit/gateway/CheckTransportSettings.h>
#include <rabit/gateway/ConfigError.h>

#include <algorithm>
#include <chrono>

#include "manager/NodeSecurity.h"

namespace Rabit
{
namespace
{

// Period with a budget. Participants' announcements are most of the cost of a silent node.
constexpr std::chrono::milliseconds LongAnnouncementPeriod{30000};

// The configured lease, or with a budget three announcement periods if none is configured.
std::chrono::milliseconds LeaseOf(const GatewayConfig &config)
{
    const bool isSet = config.Lease != GatewayConfig().Lease || config.Lines.count("lease") != 0;
    return config.Radio.Budget && !isSet ? 3 * LongAnnouncementPeriod : config.Lease;
}

}  // namespace

TransportSettings TransportSettingsOf(const GatewayConfig &config, std::uint64_t incarnation)
{
    TransportSettings settings;
    settings.Node = config.Node;
    settings.Incarnation = incarnation;
    settings.Domain = config.Domain;
    settings.Interfaces = config.Interfaces;
    settings.Peers = config.Peers;
    settings.Multicast = config.Multicast;
    settings.MaxDatagram = config.MaxDatagram;
    settings.SharedMemory = config.SharedMemory;
    settings.Lease = LeaseOf(config);
    settings.AnnouncementPeriod =
        std::min(config.Radio.Budget ? LongAnnouncementPeriod : TransportSettings().AnnouncementPeriod,
                 settings.Lease / 3);
    settings.BackendConfig = config.BackendConfig;
    settings.Log = [](const std::string &line)
    { RabitLog::Write(RabitLogLevel::Warning, "transport: " + line); };
    return settings;
}

int LineOfSetting(const GatewayConfig &config, const std::string &setting)
{
    const auto line = config.Lines.find(setting);
    return line == config.Lines.end() ? 0 : line->second;
}

std::vector<std::string> CheckTransportSettings(const GatewayConfig &config, const Transport &transport)
{
    constexpr std::uint64_t AnyIncarnation = 1;
    std::vector<std::string> missing;
    TransportSettings settings = TransportSettingsOf(config, AnyIncarnation);
    try
    {
        NodeMembers members;
        AddSecurity(config, settings, members);
    }
    catch (const TransportError &error)
    {
        throw ConfigError(config.File, LineOfSetting(config, error.Setting()), error.what());
    }
    for (const SettingsProblem &problem : transport.Check(settings))
    {
        const ConfigError error(config.File, LineOfSetting(config, problem.Setting), problem.Text);
        if (problem.Impossible)
        {
            throw error;
        }
        missing.emplace_back(error.what());
    }
    return missing;
}

}  // namespace Rabit
