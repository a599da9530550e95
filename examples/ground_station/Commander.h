#pragma once

#include "AreaLog.h"
#include "CommandLog.h"
#include "NodeState.h"
#include "ground.idl.h"
#include "uav.idl.h"

#include <rabit/RabitManager.h>
#include <rabit/gateway/Fleet.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>

namespace Ground
{

// Commands the aircraft, and follows each command to its end: the manager `Commands`.
//
// Queue:   Commands takes Ground::Order, a person's order for one aircraft; Uav::SearchArea, an area in which
//          the fleet should search; and Uav::CommandAck, from any aircraft.
// Sends:   Uav::Goto, Uav::GoHome and Uav::Search to the queue MissionControl of an aircraft: those ordered,
//          and those that its settings demand.
// Posts:   Geofence (Uav::Geofence), at the start; SearchArea (Uav::SearchArea), when a person wants one, and
//          the first one of its settings once all that are there have reported that they have none;
//          CommandList (Ground::CommandList), CommandTally (Ground::CommandTally) and AreaList
//          (Ground::AreaList), when they change.
// Fetches: Gateway/Fleet, and <node>/Pose and <node>/MissionState of each node.
//
// An area commands the whole fleet, so a restart must not bring an old one back. Aircraft keep the area with
// the highest number. They report that number, and the next area gets a higher one than all of theirs.
//
// It also ends the run when its time is over or on RequestEnd: it sends nothing more, waits for outstanding
// answers, and shuts all managers down.
class Commander : public Rabit::RabitManager
{
public:
    struct Settings
    {
        // Name of this node: aircraft send their answers to <node>/Commands.
        std::string Node = "ground";
        // The id of the first command, see CommandLog.
        std::uint32_t FirstId = 1;
        // The first search area of a fleet that has none. The Commander sets its number.
        std::optional<Uav::SearchArea> Area{};
        // The fence of the fleet; a radius of 0: none.
        Uav::Geofence Fence{};
        // Aircraft that get a Search, once in each incarnation, as soon as they are UP with a fresh pose;
        // `*` is all aircraft. Only until the first Order for that aircraft: from then on a person commands
        // it.
        std::set<std::string> Searchers{};
        // Interval at which every aircraft gets a Goto; none: never.
        std::optional<std::chrono::milliseconds> Period{};
        // Time from the first pose of an aircraft to its first command, at most an eighth of the duration.
        // Meanwhile the aircraft is seen flying on its own.
        std::chrono::milliseconds FirstAfter{2000};
        // Duration of the run; none: until RequestEnd.
        std::optional<std::chrono::milliseconds> Duration{};
        // Commands stop this long before the end (at most half of the duration), so that the last answers
        // come in time. At the end, outstanding answers are awaited for as long again.
        std::chrono::milliseconds Quiet{3000};
    };
    // CommandList holds at most this many commands, the newest.
    static constexpr std::size_t MaxListed = 200;

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
    // Least interval at which commands by settings are sent, and refused ones are retried.
    static constexpr std::chrono::milliseconds WorkPeriod{100};
    // The Commander sends commands by settings only while the aircraft's pose is younger than this.
    static constexpr double PoseFreshS = 1.0;
    // Time from the first command of an aircraft in which its MissionState is waited for.
    static constexpr std::chrono::seconds ReportPatience{5};

    // An aircraft that may be commanded.
    struct Aircraft
    {
        std::shared_ptr<Uav::Pose> Pose;
        std::shared_ptr<Uav::MissionState> State;
        std::optional<std::chrono::nanoseconds>
            First;  // when the first command is due; none: no pose has come
        std::optional<std::chrono::nanoseconds> NextGoto;  // when the next Goto of the period is due
        std::uint64_t ToldToSearch = 0;                    // the incarnation that got the Search
        std::uint64_t Life = 0;                            // the last incarnation that was UP with a fresh
                                                           // pose; 0: none
        double HeardS = 0;                                 // when it was last UP with a fresh pose in that
                                                           // incarnation
        std::uint64_t LifeWithArea = 0;                    // in which its area was looked at
        bool IsReplay = false;                             // it replays a recording
        bool WithoutOrders = false;                        // see NodeCommands
    };

    void TakeMessages();
    void Obey(const Order &order);
    void Take(Uav::SearchArea area);
    void LookAtAreas(std::chrono::nanoseconds elapsed);
    void FollowMissionStates();
    // True if the first area has not reached that aircraft yet, which would decline to search.
    bool MayLackArea(const Aircraft &aircraft, std::chrono::nanoseconds elapsed) const;
    void CommandBySettings(std::chrono::nanoseconds elapsed);
    void CommandBySettings(const Rabit::Gateway::NodeStatus &status, std::chrono::nanoseconds elapsed);
    void LookForNewLife(const std::string &node, std::uint64_t life);
    void FollowReceipts();
    Aircraft &AircraftOf(const std::string &node);
    // Hands the command of that number to the gateway. False: it was refused, and nothing was sent.
    bool Send(const CommandStatus &command, float speedMps);
    bool SendGoto(const std::string &node, const Uav::Pose &pose);
    void PostIfChanged();
    void PostTallyIfChanged();
    void PostAreasIfChanged();
    void EndIfDone(std::chrono::nanoseconds elapsed);
    bool IsQuiet(std::chrono::nanoseconds elapsed) const;
    std::chrono::nanoseconds FirstAfter() const;

    const Settings _settings;
    std::chrono::nanoseconds _start{0};
    double _elapsedS = 0;
    std::atomic<bool> _endRequested{false};
    std::optional<std::chrono::nanoseconds> _waitingSince;  // for outstanding answers
    CommandLog _log;
    AreaLog _areaLog;
    std::map<std::uint32_t, std::shared_ptr<Rabit::RabitQueueReceipt>> _onWay;  // by the command's number
    std::map<std::string, Aircraft, NaturalOrder> _aircraft;
    std::set<std::string> _ordered;  // those that a person has commanded
    std::shared_ptr<Rabit::Gateway::Fleet> _fleet = std::make_shared<Rabit::Gateway::Fleet>();
    std::shared_ptr<Uav::Geofence> _fence = std::make_shared<Uav::Geofence>();
    std::shared_ptr<Uav::SearchArea> _area =
        std::make_shared<Uav::SearchArea>();  // number 0: none was posted
    bool _areaIsWanted = false;               // by a person, in this run
    std::uint32_t _highestArea = 0;           // of the numbers that aircraft report
    std::shared_ptr<CommandTally> _tally = std::make_shared<CommandTally>();
    std::shared_ptr<CommandList> _list = std::make_shared<CommandList>();
    std::shared_ptr<AreaList> _areas = std::make_shared<AreaList>();
};

}  // namespace Ground
