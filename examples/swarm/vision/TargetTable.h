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

// Makes targets of detections: those of this aircraft's own camera and of others', in any order. And gives
// each target one name in the whole fleet, together with the tables of the other aircraft.
//
// Of each frame the detections are given to the targets so that all together fit best, within the gate, and
// each target takes one. What fits none begins a new target, which is tentative: it is reported only when it
// has been seen NeededSightings times within ConfirmWithinS, so that a false alarm, which nothing agrees
// with, is never reported. One that does not get there is forgotten.
//
// A new target may be one that was not seen for a while and has moved meanwhile: it is taken for that one if
// its place is likelier so than for a target that was never seen. Two that go on fitting one place are one,
// unless one frame has shown both.
//
// Names. Every aircraft has a table, and hears of the detections of all as long as the radio lets it, so each
// knows all targets, and none is in charge. The aircraft that saw a target first names it; the others wait
// for the name for NameWaitS. They tell each other the names at once when one is new or two were merged, and
// again and again. If a target has two names, because of two aircraft that did not hear each other, the older
// one holds and the other one is kept as a former name, which tells whoever knew the target by it. An
// aircraft that starts anew learns the names from the others. If two aircraft mean different targets by one
// name, the one whose own name comes later gives way.
//
// Times are GPS times. What the network brings may be anything: values that make no sense are dropped and
// counted. Not thread-safe.
class TargetTable
{
public:
    // 99 % of a chi-square distribution with two degrees of freedom: -2 ln 0.01. With four: PairGate.
    static constexpr double Gate = 9.2103;
    static constexpr double PairGate = 13.277;
    static constexpr double BiasM =
        1.5;  // by which aircraft are wrong about their own position, north and east
    static constexpr double DirectM = 6;      // one that is more uncertain takes no single detection
    static constexpr double NewPerM2 = 5e-7;  // how likely it is to come upon a target that was never seen
    static constexpr double FirstSigmaM = 4;  // of the place where a target was seen first
    static constexpr std::size_t NeededSightings = 4;
    static constexpr double ConfirmWithinS = 3;
    static constexpr double MergeAfterS = 2;  // that two fit one place
    static constexpr int TwoInFrames = 3;     // so many frames that show both prove that they are two
    static constexpr int OneInFrames =
        6;  // so many in a row that show one in the place of both, that one is elsewhere
    static constexpr double SeenNowS = 3;
    static constexpr double ForgetAfterS = 1200;
    static constexpr double MaxLatenessS = 5;      // frames older than this, against the newest, are dropped
    static constexpr std::size_t MaxTargets = 64;  // the bounds of the message Targets
    static constexpr std::size_t MaxTentative = 200;
    static constexpr double NameWaitS = 2;
    static constexpr double TellAgainS = 5;       // of those that this aircraft has named
    static constexpr double TellForOthersS = 12;  // of those of which nobody has told for so long
    static constexpr double BesideM = 100;        // nearer than this, others are told that two are two
    static constexpr double SwappedM =
        15;  // farther than this from where another sees it, it is not the same

    explicit TargetTable(std::string aircraft) : _aircraft(std::move(aircraft)) {}

    void Add(const Uav::Detections &frame);
    // What the table of another aircraft tells.
    void Hear(const Uav::Targets &told);
    // The targets as they are at that time.
    void Report(double gpsTimeS, Uav::Targets &targets) const;
    // Those of which the other aircraft are to be told now; often none.
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
    // What is known of two targets.
    struct Pair
    {
        int Frames = 0;  // that have shown both
        std::optional<double> FitSinceS{};
        double FitLastS = 0;
        bool IsJudged = false;  // whether the one is the other, come back
        // Frames in a row that showed one detection where both might have been.
        int Alone = 0;
        int AloneFirst = 0;  // of which it was given to the first
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
    std::map<std::string, std::uint32_t> _frames;  // the last number that each aircraft gave one
    std::uint64_t _lastId = 0;
    std::uint32_t _lastNumber = 0;
    double _newestS = 0;
    std::uint64_t _dropped = 0;
};

}  // namespace Swarm
