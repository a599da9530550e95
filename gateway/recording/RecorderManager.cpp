#include <rabit/RabitLog.h>
#include <rabit/RabitVersion.h>
#include <rabit/gateway/Fleet.h>
#include <rabit/gateway/GatewayManager.h>
#include <rabit/gateway/NamePattern.h>
#include <rabit/recording/RecorderManager.h>

#include <nlohmann/json.hpp>

#include <unistd.h>

#include <array>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "recording/FolderDisk.h"
#include "recording/JsonStreams.h"
#include "recording/MessageTaps.h"
#include "recording/ProblemWatch.h"
#include "recording/QueueStreams.h"
#include "recording/StepRecorder.h"

namespace Rabit
{
namespace
{

constexpr double LookPeriodSec = 0.1;

RecordingSettings SettingsOf(const GatewayConfig &config)
{
    if (!config.Record)
    {
        throw std::invalid_argument("RecorderManager: the configuration does not say what to record");
    }
    return {.Name = config.Node, .Record = *config.Record, .RemovesOwnStart = true};
}

Mcap::TextMap NodeMetadata(const GatewayConfig &config)
{
    std::array<char, 256> host{};
    static_cast<void>(::gethostname(host.data(), host.size() - 1));
    return {{"node", config.Node},
            {"version", RABIT_VERSION_STRING},
            {"host", host.data()},
            {"process", std::to_string(::getpid())},
            {"domain", std::to_string(config.Domain)},
            {"transport", config.Transport}};
}

// The text of the configuration file; nothing if the configuration was made in code.
Mcap::TextMap ConfigurationMetadata(const GatewayConfig &config)
{
    if (config.File.empty())
    {
        return {};
    }
    std::ifstream stream(config.File, std::ios::binary);
    return {{"file", config.File}, {"text", std::string(std::istreambuf_iterator<char>(stream), {})}};
}

nlohmann::ordered_json LogLine(std::uint64_t time, RabitLogLevel level, const std::string &text)
{
    constexpr std::uint64_t second = 1000000000;
    return {{"timestamp", {{"sec", time / second}, {"nsec", time % second}}},
            {"level", static_cast<int>(level) + 1},
            {"message", text},
            {"name", "rabit"},
            {"file", ""},
            {"line", 0}};
}

}  // namespace

class RecorderManager::Parts
{
public:
    Parts(GatewayConfig &config, RabitWorkspace &workspace, std::unique_ptr<RecordingDisk> disk)
        : _settings(SettingsOf(config)),
          _workspace(workspace),
          _target(std::make_shared<RecordingTarget>(
              config.Node, workspace.GetClock(),
              disk ? std::move(disk) : std::make_unique<FolderDisk>(_settings.Record.Folder), _settings)),
          _config(config),
          _taps(_config, workspace, _target)
    {
        _target->Inbox().SetMetadata("rabit.node", NodeMetadata(config));
        if (Mcap::TextMap text = ConfigurationMetadata(config); !text.empty())
        {
            _target->Inbox().SetMetadata("rabit.configuration", std::move(text));
        }
        config.Tap = std::make_shared<QueueStreams>(_target, *config.Record);
        if (!config.Record->Steps.empty())
        {
            _workspace.SetManagerTracing(
                [&workspace, target = _target, wanted = config.Record->Steps](
                    const std::string &manager) -> std::shared_ptr<RabitManagerTrace>
                {
                    return MatchesAny(wanted, manager)
                               ? std::make_shared<StepRecorder>(manager, workspace, target)
                               : nullptr;
                });
        }
        const std::uint32_t log = _target->Inbox().AddStream(JsonStreams::Log(config.Node));
        if (config.Record->BlackBox && config.Record->BlackBox->Problems)
        {
            _fleet = std::make_shared<Gateway::Fleet>();
            if (!workspace.AddPublishSubscribeMessage(FleetMessageNameOf(config), _fleet))
            {
                _fleet.reset();  // the gateway says so
            }
        }
        _log = RabitLog::Listen([target = _target, log](RabitLogLevel level, const std::string &text)
                                { target->PutJson(log, LogLine(target->Now(), level, text)); });
    }
    ~Parts()
    {
        _log.reset();
        if (!_config.Record->Steps.empty())
        {
            _workspace.SetManagerTracing(nullptr);
        }
        _target->End();
    }
    void Look()
    {
        _taps.Look();
        if (_fleet && _fleet->FetchMessage())
        {
            if (const std::string problem = _problems.Look(*_fleet); !problem.empty())
            {
                _target->Happened("problem " + problem);
            }
        }
    }
    void AddSubscription(const SubscribeRule &rule) { _taps.AddSubscription(rule); }
    void Happened(const std::string &what) { _target->Happened(what); }
    const std::shared_ptr<RecordingTarget> &Target() const { return _target; }

private:
    const RecordingSettings _settings;
    RabitWorkspace &_workspace;
    const std::shared_ptr<RecordingTarget> _target;
    const GatewayConfig _config;  // a copy without the tap, which keeps the target alive
    MessageTaps _taps;
    std::shared_ptr<Gateway::Fleet> _fleet;  // null: nobody waits for problems
    ProblemWatch _problems;
    std::shared_ptr<void> _log;
};

RecorderManager::RecorderManager(GatewayConfig &config)
    : RecorderManager(config, *RabitWorkspace::GetWorkspace())
{
}

RecorderManager::RecorderManager(GatewayConfig &config, RabitWorkspace &workspace)
    : RecorderManager(config, workspace, nullptr)
{
}

RecorderManager::RecorderManager(GatewayConfig &config, RabitWorkspace &workspace,
                                 std::unique_ptr<RecordingDisk> disk)
    : RabitManager("Recorder", workspace), _parts(std::make_unique<Parts>(config, workspace, std::move(disk)))
{
    SetPeriodSec(LookPeriodSec);
}

RecorderManager::~RecorderManager() = default;

const std::shared_ptr<RecordingTarget> &RecorderManager::Target() const
{
    return _parts->Target();
}

void RecorderManager::Startup()
{
    _parts->Look();
}

void RecorderManager::ExecuteUnitOfWork()
{
    _parts->Look();
}

void RecorderManager::AddSubscription(const SubscribeRule &rule)
{
    _parts->AddSubscription(rule);
}

void RecorderManager::WriteBlackBox(const std::string &why)
{
    _parts->Happened(why);
}

void RecorderManager::Shutdown()
{
    _parts->Look();
}

}  // namespace Rabit
