#include "FleetSession.h"

#include <rabit/RabitLog.h>
#include <rabit/gateway/ConfigError.h>
#include <rabit/gateway/GatewayManager.h>
#include <rabit/transport/TransportFactory.h>

#include <algorithm>

#include "Offers.h"
#include "Output.h"
#include "SafeText.h"
#include "doctor/MachineChecks.h"
#include "doctor/NetworkChecks.h"
#include "doctor/NetworkTrial.h"

namespace Rabit::Tool
{

FleetSession::FleetSession(const GatewayConfig &config, const CommonOptions &options, Wakeup &wakeup)
    : _config(config), _options(options), _wakeup(wakeup)
{
    // The commands themselves report the gateway's warnings where they matter, so these are logged only with
    // --verbose.
    RabitLog::SetLevel(options.Verbose ? RabitLogLevel::Warning : RabitLogLevel::Error);
    try
    {
        auto gateway = std::make_unique<GatewayManager>(config, MakeTransport(config.Transport), _workspace);
        _explorer = &gateway->Explorer();
        _reactor.AddManager(std::move(gateway));
    }
    catch (const ConfigError &error)
    {
        throw NetworkError(error.what());
    }
    _explorer->SetOnChange([this] { _wakeup.Notify(); });
    _workspace.AddPublishSubscribeMessage(FleetMessageNameOf(config), _fleet);
    _fleet->GetGlobalPublishSubscribeMessageRef()->ConnectSomethingPublished(
        RabitQuickHandler([this] { _wakeup.Notify(); }));
    _reactor.SetHandleSignals(false);
    _runner = std::thread([this] { _reactor.Run(); });
}

FleetSession::~FleetSession()
{
    _reactor.ShutdownAllManagers();
    _runner.join();
}

Gateway::Fleet FleetSession::Fleet() const
{
    _fleet->FetchMessage();
    return *_fleet;
}

bool FleetSession::WaitUntil(double seconds, const std::function<bool()> &holds)
{
    const auto length = std::chrono::duration<double>(seconds);
    return _wakeup.WaitUntil(_start + std::chrono::duration_cast<std::chrono::steady_clock::duration>(length),
                             holds);
}

bool FleetSession::WaitForOffers(const std::string &pattern, const std::function<bool()> &holds)
{
    // With --wait the user asks to wait for nodes that are yet to come.
    const bool mayCome = _options.IsWaitGiven;
    const auto ends = [&]
    {
        const std::vector<Node> nodes = Nodes();
        const bool isEverybodyHeard = !mayCome && Seconds() >= Offers::SecondsToHearEverybody(nodes);
        return holds() || Offers::AreAllThere(nodes, pattern, isEverybodyHeard);
    };
    // The nodes that are heard meanwhile may announce longer periods.
    bool hasEnded = false;
    for (double until = 0.0; !hasEnded && until < _options.Wait;)
    {
        const double everybody = Offers::SecondsToHearEverybody(Nodes());
        until = everybody > until ? std::min(everybody, _options.Wait) : _options.Wait;
        hasEnded = WaitUntil(until, ends);
    }
    return holds();
}

void FleetSession::WaitForRest()
{
    constexpr double longer = 3.0;
    if (IsAnybodyThere() && !_options.IsWaitGiven)
    {
        WaitUntil(_options.Wait + longer, [this] { return Offers::AreComplete(Nodes()); });
    }
}

double FleetSession::Seconds() const
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - _start).count();
}

// Reports nodes with keys: such a fleet does not answer a tool without keys, but everybody can hear its
// announcements.
void FleetSession::TellOfKeys()
{
    constexpr double twoAnnouncements = 2.2;  // unless a budget makes them rarer
    try
    {
        const Doctor::NetworkTrial trial(Doctor::UsedBy(_config, Doctor::LookAtMachine().Interfaces), {},
                                         _config.Node, {_config.Domain});
        const auto ends = [this] { return _wakeup.IsInterrupted(); };
        WaitUntil(Seconds() + twoAnnouncements, ends);
        const std::vector<Doctor::Finding> findings =
            Doctor::OfKeys(_config, trial.Facts(), IsAnybodyThere());
        for (const Doctor::Finding &finding : findings)
        {
            Output::Talk(SafeText(finding.Text + " (" + finding.Advice + ")"));
        }
    }
    catch (const NetworkError &)
    {
        // Nothing is known about keys.
    }
}

int FleetSession::NobodyThere()
{
    Output::Talk("nobody was heard in domain " + std::to_string(_config.Domain) + " over " +
                 _config.Transport +
                 "; `rabit doctor` finds the reason (--domain, --interface, --wait; "
                 "gateway/CONNECTING.md)");
    for (const Gateway::Problem &problem : Fleet().problems)
    {
        Output::Talk(problem.subject + ": " + problem.reason);
    }
    TellOfKeys();
    return NoNetwork;
}

}  // namespace Rabit::Tool
