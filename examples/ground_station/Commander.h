#pragma once

#include "CommandLog.h"
#include "gateway.idl.h"
#include "ground.idl.h"
#include "uav.idl.h"

#include <rabit/RabitManager.h>

#include <atomic>
#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <string>

namespace Ground
{

// Sends every live aircraft a Goto again and again, and books the answers: the manager `Commands`.
//
// Queue:   Commands takes Uav::CommandAck, from whichever aircraft has one.
// Sends:   Uav::Goto to the queue MissionControl of each aircraft that is UP and whose pose is known.
// Posts:   CommandTally (Ground::CommandTally), when it changes.
// Fetches: Gateway/Fleet, and <node>/Pose of each node.
//
// It also ends the run, when its time is over or when it is asked to: it sends nothing more, waits for the
// answers that are still out, and shuts all managers down.
class Commander : public Rabit::RabitManager
{
public:
    struct Settings
    {
        // Name of this node: answers are to come to <node>/Commands.
        std::string Node = "ground";
        // Between two commands to one aircraft.
        std::chrono::milliseconds Period{15000};
        // From the first pose of an aircraft to the first command (but at most an eighth of the duration): so
        // long it is seen flying by itself.
        std::chrono::milliseconds FirstAfter{2000};
        // How long to run; none: until RequestEnd.
        std::optional<std::chrono::milliseconds> Duration{};
        // Nothing is sent this long before the end (but for at most half of the duration), so that the last
        // answers come in time. Those that have not are waited for as long again.
        std::chrono::milliseconds Quiet{3000};
    };

    explicit Commander(Settings settings,
                       Rabit::RabitWorkspace &workspace = *Rabit::RabitWorkspace::GetWorkspace());

    void Startup() final;
    void ExecuteUnitOfWork() final;

    // Ends the run as if its time were over. Any thread; not from a signal handler.
    void RequestEnd();

    // Call these when the reactor's Run has returned.
    const CommandLog &Log() const { return _log; }
    double ElapsedS() const { return _elapsedS; }

private:
    static constexpr std::chrono::milliseconds WorkPeriod{100};
    // An aircraft is commanded only while its pose is known this well.
    static constexpr double PoseFreshS = 1.0;

    // A node that may be commanded.
    struct Target
    {
        std::shared_ptr<Uav::Pose> Pose;
        std::optional<std::chrono::nanoseconds> Next;  // when the next command is due; none: no pose has come
    };

    void TakeAnswers();
    void SendCommands(std::chrono::nanoseconds elapsed);
    Target &TargetOf(const std::string &node);
    bool Send(const std::string &node, const Uav::Pose &pose);
    void PostTally();
    void EndIfDone(std::chrono::nanoseconds elapsed);
    bool IsQuiet(std::chrono::nanoseconds elapsed) const;
    std::chrono::nanoseconds FirstAfter() const;

    const Settings _settings;
    std::chrono::nanoseconds _start{0};
    double _elapsedS = 0;
    std::atomic<bool> _endRequested{false};
    std::optional<std::chrono::nanoseconds> _waitingSince;  // for the last answers
    CommandLog _log;
    std::map<std::string, Target> _targets;
    std::shared_ptr<Rabit::Gateway::Fleet> _fleet = std::make_shared<Rabit::Gateway::Fleet>();
    std::shared_ptr<CommandTally> _tally = std::make_shared<CommandTally>();
};

}  // namespace Ground
