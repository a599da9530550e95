#pragma once

#include "../Geo.h"
#include "FollowedTarget.h"
#include "uav.idl.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace Swarm
{

// Makes targets from the detections of all aircraft's cameras, in any order. Together with the tables of
// the other aircraft it gives each target one name in the whole fleet.
//
// In each frame the detections are assigned to the targets with the best total fit, within the gate, at
// most one to each target. An unassigned detection begins a tentative target. A tentative target is
// reported only after NeededSightings sightings within ConfirmWithinS, so that single false alarms are
// never reported; otherwise it is forgotten.
//
// A new target may be one that was not seen for a while and has moved meanwhile. It is taken for that one
// if that is likelier than a new target at its place. Two targets that keep fitting one place are merged,
// unless one frame has shown both.
//
// Names. Every aircraft has a table and gets the detections of all aircraft as far as the radio allows. So
// each knows all targets, and there is no leader. The aircraft that saw a target first names it; the others
// wait for the name for NameWaitS. They send each other names at once when one is new or two were merged, and
// then periodically. If two aircraft did not hear each other and gave a target two names, the older one
// holds. The other is kept as a former name for those who know it. A restarted aircraft learns the names from
// the others. If two aircraft mean different targets by one name, the one whose own name comes later gives
// way.
//
// Times are GPS times. Implausible values from the network are dropped and counted. Not thread-safe.
class TargetTable
{
public:
    // 99 % of a chi-square distribution with two degrees of freedom: -2 ln 0.01. With four: PairGate.
    static constexpr double Gate = 9.2103;
    static constexpr double PairGate = 13.277;
    static constexpr double BiasM = 1.5;      // error of an aircraft's own position, north and east
    static constexpr double DirectM = 6;      // a target more uncertain than this is not assigned a single
                                              // detection
    static constexpr double NewPerM2 = 5e-7;  // density of targets that were never seen
    static constexpr double FirstSigmaM = 4;  // of the place where a target was seen first
    static constexpr std::size_t NeededSightings = 4;
    static constexpr double ConfirmWithinS = 3;
    static constexpr double MergeAfterS = 2;  // that two must fit one place
    static constexpr int TwoInFrames = 3;     // frames that show both, to prove that they are two
    static constexpr int OneInFrames =
        6;  // frames in a row that show one in the place of both, to prove that one is elsewhere
    static constexpr double SeenNowS = 3;
    static constexpr double ForgetAfterS = 1200;
    static constexpr double MaxLatenessS = 5;      // frames older than this, against the newest, are dropped
    static constexpr std::size_t MaxTargets = 64;  // the bounds of the message Targets
    static constexpr std::size_t MaxTentative = 200;
    static constexpr double NameWaitS = 2;
    static constexpr double TellAgainS = 5;       // for targets that this aircraft has named
    static constexpr double TellForOthersS = 12;  // for targets that no aircraft has sent for this long
    static constexpr double BesideM = 100;        // pairs nearer than this are sent to the others as
                                                  // different
    static constexpr double SwappedM =
        15;  // farther than this from another aircraft's place, it is not the same target

    explicit TargetTable(std::string aircraft) : _aircraft(std::move(aircraft)) {}

    void Add(const Uav::Detections &frame);
    // Accepts targets from the table of another aircraft.
    void Hear(const Uav::Targets &told);
    // Fills in the targets at that time.
    void Report(double gpsTimeS, Uav::Targets &targets) const;
    // Returns the targets to send to the other aircraft now; often none.
    Uav::Targets Tell(double gpsTimeS);
    std::uint64_t Dropped() const { return _dropped; }

private:
    struct Sighting
    {
        TargetFilter::Place Place;
        double SigmaM = 0;  // with the aircraft's own error
        std::uint64_t Target = 0;
    };
    // Where a target was at some time.
    struct Moment
    {
        TargetFilter Filter;
        double LastS;
    };
    // Evidence about a pair of targets.
    struct Pair
    {
        int Frames = 0;  // that have shown both
        std::optional<double> FitSinceS{};
        double FitLastS = 0;
        bool IsJudged = false;  // already checked whether one is the other, come back
        // Frames in a row that showed one detection where both might have been.
        int Alone = 0;
        int AloneFirst = 0;  // of these, assigned to the first
        std::optional<Moment> FirstBefore{};
        std::optional<Moment> SecondBefore{};
    };
    using PairKey = std::pair<std::uint64_t, std::uint64_t>;

    // TargetTable.cpp
    bool Accept(const Uav::Detections &frame);
    std::vector<Sighting> SightingsOf(const Uav::Detections &frame);
    void Match(std::vector<Sighting> &sightings, const Uav::Detections &frame);
    void NoteTogether(const std::vector<Sighting> &sightings);
    void NoteAlone(const FollowedTarget &seen, const FollowedTarget &missed);
    FollowedTarget *Find(std::uint64_t id);
    void Forget();
    std::vector<Uav::TargetName> NamesBeside(const FollowedTarget &item, double gpsTimeS) const;
    Uav::Target ToMessage(const FollowedTarget &target, double gpsTimeS) const;

    // TargetIdentity.cpp
    static PairKey KeyOf(const FollowedTarget &a, const FollowedTarget &b);
    bool AreTwo(const FollowedTarget &a, const FollowedTarget &b) const;
    bool FitOnePlace(const FollowedTarget &a, const FollowedTarget &b) const;
    void Confirm();
    bool IsSeenAlready(const FollowedTarget &tentative) const;
    void KnowAgain();
    void MergeThoseThatFit();
    void PartThoseOnOnePlace();
    void ForgetPairsSince(const FollowedTarget &target);
    void Merge(std::uint64_t keptId, std::uint64_t otherId);

    // TargetNames.cpp
    struct Told
    {
        const Uav::Target *Message;
        TargetFilter::Place Place;
        double SigmaM;
    };
    void GiveNames(double gpsTimeS);
    void GiveName(FollowedTarget &target);
    void NoteNumbers(const Uav::Targets &told);
    void NoteLife(const Uav::Detections &frame);
    std::optional<Told> Read(const Uav::Target &message, const Uav::Targets &told);
    void TakeApart(const Uav::Target &told);
    std::uint64_t FindByName(const Told &told);
    bool IsElsewhere(const FollowedTarget &target, const Told &told) const;
    std::uint64_t Agree(std::uint64_t id, const Told &told, const Uav::Targets &all);
    void TellNeighbours();
    bool GiveWay(std::uint64_t id, const Told &told, const std::string &toldBy);
    std::uint64_t FindByPlace(const Told &told, const std::vector<std::uint64_t> &taken);
    void Learn(FollowedTarget &target, const Told &told, double gpsTimeS);
    void AddToldTarget(const Told &told, double gpsTimeS);

    const std::string _aircraft;
    std::optional<GeoPoint> _origin;  // of the metres; where the first frame was taken
    std::vector<FollowedTarget> _items;
    std::map<PairKey, Pair> _pairs;
    std::map<std::string, std::uint32_t> _frames;  // the last frame number of each aircraft
    std::uint64_t _lastId = 0;
    std::uint32_t _lastNumber = 0;
    double _newestS = 0;
    std::uint64_t _dropped = 0;
};

}  // namespace Swarm
