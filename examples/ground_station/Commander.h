#pragma once

#include "CommandLog.h"
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
// Queue:   Commands takes Ground::Order, what a person wants of one aircraft; Uav::SearchArea, where a person
//          wants the fleet to search; and Uav::CommandAck, from whichever aircraft has one.
// Sends:   Uav::Goto, Uav::GoHome and Uav::Search to the queue MissionControl of an aircraft: those ordered,
//          and by itself what its settings say.
// Posts:   SearchArea (Uav::SearchArea), at the start and when it changes; CommandList (Ground::CommandList)
//          and CommandTally (Ground::CommandTally), when they change.
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
        // The id of the first command, see CommandLog.
        std::uint32_t FirstId = 1;
        // Where the fleet is to search, until somebody says otherwise. Its number is set here.
        Uav::SearchArea Area{};
        // Aircraft that are told to search, once in each of their lives, as soon as they are heard well; `*`
        // is all of them. Only until the first Order for that aircraft: from then on a person commands it.
        std::set<std::string> Searchers{};
        // Every aircraft gets a Goto this often; none: never.
        std::optional<std::chrono::milliseconds> Period{};
        // From the first pose of an aircraft to the first command (but at most an eighth of the duration): so
        // long it is seen flying by itself.
        std::chrono::milliseconds FirstAfter{2000};
        // How long to run; none: until RequestEnd.
        std::optional<std::chrono::milliseconds> Duration{};
        // Nothing is sent this long before the end (but for at most half of the duration), so that the last
        // answers come in time. Those that have not are waited for as long again.
        std::chrono::milliseconds Quiet{3000};
    };
    // CommandList holds so many at most, the newest.
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
    // Commands by settings are sent this often at most, and refused ones are tried again.
    static constexpr std::chrono::milliseconds WorkPeriod{100};
    // An aircraft is commanded by itself only while its pose is known this well.
    static constexpr double PoseFreshS = 1.0;

    // An aircraft that may be commanded.
    struct Aircraft
    {
        std::shared_ptr<Uav::Pose> Pose;
        std::optional<std::chrono::nanoseconds>
            First;  // when the first command is due; none: no pose has come
        std::optional<std::chrono::nanoseconds> NextGoto;  // when the next Goto of the period is due
        std::uint64_t ToldToSearch = 0;                    // the life of it that was told
        std::uint64_t Life = 0;                            // the last one that was heard well; 0: none
        double HeardS = 0;                                 // when it was last heard well in that life
        bool WithoutOrders = false;                        // see NodeCommands
    };

    void TakeMessages();
    void Obey(const Order &order);
    void Take(Uav::SearchArea area);
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
    void EndIfDone(std::chrono::nanoseconds elapsed);
    bool IsQuiet(std::chrono::nanoseconds elapsed) const;
    std::chrono::nanoseconds FirstAfter() const;

    const Settings _settings;
    std::chrono::nanoseconds _start{0};
    double _elapsedS = 0;
    std::atomic<bool> _endRequested{false};
    std::optional<std::chrono::nanoseconds> _waitingSince;  // for the last answers
    CommandLog _log;
    std::map<std::uint32_t, std::shared_ptr<Rabit::RabitQueueReceipt>> _onWay;  // by the command's number
    std::map<std::string, Aircraft> _aircraft;
    std::set<std::string> _ordered;  // those that a person has commanded
    std::shared_ptr<Rabit::Gateway::Fleet> _fleet = std::make_shared<Rabit::Gateway::Fleet>();
    std::shared_ptr<Uav::SearchArea> _area = std::make_shared<Uav::SearchArea>();
    std::shared_ptr<CommandTally> _tally = std::make_shared<CommandTally>();
    std::shared_ptr<CommandList> _list = std::make_shared<CommandList>();
};

}  // namespace Ground
