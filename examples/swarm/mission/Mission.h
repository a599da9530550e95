#pragma once

#include "../Geo.h"
#include "Floor.h"
#include "LawnMower.h"
#include "TargetBook.h"
#include "uav.idl.h"

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>

namespace Swarm
{

// The actions of a mission on its surroundings.
class MissionOutput
{
public:
    virtual ~MissionOutput() = default;
    // Makes the autopilot fly there and circle; at speed 0 it flies its own track or pattern. Returns the
    // number of the course, 0 if the autopilot does not accept it.
    virtual std::uint32_t Fly(const GeoPoint &point, float speedMps) = 0;
    // Sends the progress of a command to that queue address.
    virtual void Answer(const std::string &replyTo, const Uav::CommandAck &ack) = 0;
    // Sends to the mission control of another aircraft. False if it cannot be sent.
    virtual bool Send(const std::string &aircraft, const Uav::TargetReport &report) = 0;
    virtual bool Send(const std::string &aircraft, const Uav::Validation &validation) = 0;
};

// The inputs of a mission's decisions.
struct Situation
{
    double NowS = 0;      // by a clock that does not go back
    double GpsTimeS = 0;  // by the clock that stamps poses
    std::optional<GeoPoint> Position;
    float BatteryPercent = 0;  // NaN if it is not known
    bool WantsHome = false;    // the health monitor's cause to fly home has not passed
    Uav::FlightMode Flight;
    Uav::Targets Targets;                                 // of this aircraft's sensor fusion
    std::map<std::string, Uav::Pose> Others;              // the aircraft that are present now
    std::map<std::string, Uav::Findings> OthersFindings;  // also of aircraft that are no longer present
};

// Decides the actions of one aircraft. Has no threads, clocks or names of queues.
//
// Without a command it does nothing. After a Search it flies to the search area and searches it in lanes.
// If it is the first to see a target, it circles it (CONFIRM) and asks the other aircraft to come and look:
// one at a time, the nearest first, busy ones again after a while. When one has seen the target, this
// aircraft follows it for a while (TRACK) and searches on. If none can see it, the target is rejected. If
// it is asked itself while it searches, it flies there and looks (VALIDATE). If two aircraft pursue one
// target, or wait for each other, the one whose name comes later gives way.
//
// A Goto or GoHome ends all that. An aircraft that holds the point of a Goto and has a recorded track goes
// back to the track after a while.
//
// It declines a point and a search area below its floor, or outside of the geofence. It also declines a
// Search while the last area is declined, as it would search another area than the sender means. It flies to
// no target outside of the geofence: it rejects its own, follows none out of it, and refuses to look at those
// of others. On the way home it flies no lower than its floor.
//
// The owner calls Update, then Take for each input, then Act: each time anything may have changed, and a
// few times a second. Not thread-safe.
class Mission
{
public:
    static constexpr double LowBatteryPercent = 25;
    static constexpr double TrackS = 60;          // follows a target
    static constexpr double ValidateS = 45;       // looks for a target of another aircraft
    static constexpr double AnswerS = 55;         // waits for another aircraft's validation
    static constexpr double AskAgainS = 10;       // those that were busy
    static constexpr double PatienceS = 60;       // with those that are busy
    static constexpr double DeclinedShownS = 60;  // its text tells of a command that it declined
    static constexpr double BackToTrackS = 5;     // holds the point of a Goto if it has a recorded track
    static constexpr double StepM = 15;           // a point to fly to gets a new course if it moved this far
    static constexpr double RepeatS = 2;          // a course that the autopilot does not fly is sent again
    // While it searches and looks at targets, an aircraft flies in its own layer above the altitude of the
    // search area. The number in its name gives the layer. So aircraft that cross or circle one target stay
    // apart without coordination. uav1 and uav11 share a layer.
    static constexpr double LayerM = 10;
    static constexpr int Layers = 10;
    static constexpr float HomeSpeedMps = 16;

    Mission(std::string aircraft, MissionOutput &output, const Floor &floor = Floor());

    void Update(Situation situation);
    // A new area takes effect at once. An invalid or too low area is declined, and the previous one stays
    // in force; returns the reason. One with a lower number is an old one, and changes nothing.
    std::string Take(const Uav::SearchArea &area);
    // Holds from now on, also for the last search area that was heard. An order that is under way goes on.
    // Returns the reason if that area is declined now.
    std::string Take(const Uav::Geofence &fence);
    void Take(const Uav::Goto &command);
    void Take(const Uav::Search &command);
    void Take(const Uav::GoHome &command);
    void Take(const Uav::TargetReport &report);
    void Take(const Uav::Validation &validation);
    void Act();

    // Fills in everything but poses. The text gives the reason for its actions, if there is more to say.
    void Describe(Uav::MissionState &state) const;
    std::vector<Uav::Finding> Findings() const { return _book.Report(); }

private:
    struct Command
    {
        std::uint32_t Id = 0;
        std::string ReplyTo;
    };
    struct Course
    {
        GeoPoint Point;
        float SpeedMps = 0;
        std::uint32_t Number = 0;
        double SentS = 0;
    };

    // MissionCommands.cpp
    template <typename Message>
    void Decline(const Message &command, const std::string &reason);
    template <typename Message>
    void Accept(const Message &command, Uav::MissionMode mode);
    void Finish(Uav::CommandStage stage, const std::string &reason, std::uint32_t replacedBy = 0);
    std::string WhyNotNow(bool mayBeTired) const;
    void JudgeArea();  // the last one that was heard
    GeoPoint WhereHomeIs() const;
    void ActOnCommand();
    bool HasArrived() const;
    bool Fly(const GeoPoint &point, float speedMps);
    void FlyIfMoved(const GeoPoint &point, float speedMps);

    // MissionTargets.cpp
    bool IsSearching() const;
    void BeginSearch();
    void SearchOn();
    void ActOnSearch();
    void LeaveTarget(const std::string &reason);
    void BeginConfirm(std::uint32_t number);
    void RejectTarget();
    void AskNext();
    std::string NearestToAsk(const GeoPoint &place) const;
    Uav::TargetReport ReportOf(const Uav::Finding &finding) const;
    void ActOnConfirm();
    void ActOnTrack();
    void ActOnValidate();
    std::string WhyNotLook(const Uav::TargetReport &report);
    void Answer(const Uav::TargetReport &report, Uav::Validation answer);
    void Refuse(const Uav::TargetReport &report, const std::string &reason, bool busy);
    std::set<std::string> NamesOfOthers() const;
    GeoPoint InOwnLayer(const GeoPoint &place) const;

    const std::string _aircraft;
    MissionOutput &_output;
    const Floor _floor;
    Situation _now;
    TargetBook _book;
    std::optional<GeoPoint> _home;
    Uav::Geofence _fence;
    std::optional<Uav::SearchArea> _area;
    std::optional<Uav::SearchArea> _heardArea;  // also if it was declined
    std::string _areaDeclined;                  // why the last area is not in force
    std::optional<LawnMower> _mower;

    Uav::MissionMode _mode = Uav::MissionMode::MISSION_IDLE;
    double _modeSinceS = 0;
    std::string _why;
    bool _homeByItself = false;  // _why is the health monitor's, and has not passed
    std::string _declined;       // why the last command was declined, empty once one is accepted
    double _declinedS = 0;
    bool _hasTrack = false;
    Course _course;

    std::optional<Command> _open;  // the last command, if it has no final answer yet
    std::uint32_t _lastCommand = 0;
    std::uint32_t _commands = 0;
    GeoPoint _gotoPoint;
    float _gotoSpeedMps = 0;

    std::uint32_t _target = 0;  // of CONFIRM and TRACK
    std::string _partner;
    std::set<std::string> _asked;  // in this round
    bool _anyBusy = false;         // in this round
    double _askedS = 0;            // when the partner was asked; without one, when the round ended
    double _trackedBeforeS = 0;
    Uav::TargetReport _report;   // of VALIDATE
    double _reportGpsTimeS = 0;  // when it came
};

}  // namespace Swarm
