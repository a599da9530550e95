#pragma once

#include "../Geo.h"
#include "TargetFilter.h"
#include "uav.idl.h"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace Swarm
{

// Makes targets of detections: those of this aircraft's own camera and of others', in any order.
//
// A detection goes to the target to which it fits best (nearest neighbour, within the gate), and each target
// takes one detection of a frame. What fits none begins a new target, which is tentative: it is reported, and
// gets a number, only when it has been seen NeededSightings times within ConfirmWithinS, so that a false
// alarm, which nothing agrees with, is never reported. One that does not get there is forgotten.
//
// Times are GPS times. What the network brings may be anything: values that make no sense are dropped and
// counted. Not thread-safe.
class TargetTable
{
public:
    // 99 % of a chi-square distribution with two degrees of freedom: -2 ln 0.01.
    static constexpr double Gate = 9.2103;
    static constexpr double FarthestM = 30;  // however uncertain the target is
    static constexpr std::size_t NeededSightings = 4;
    static constexpr double ConfirmWithinS = 3;
    static constexpr double SameM = 8;  // nearer than this to a known target a new one is the same
    static constexpr double ForgetAfterS = 300;
    static constexpr double MaxLatenessS = 5;      // frames older than this, against the newest, are dropped
    static constexpr std::size_t MaxTargets = 64;  // the bounds of the message Targets
    static constexpr std::size_t MaxTentative = 200;
    static constexpr std::size_t MaxSeers = 32;

    explicit TargetTable(std::string aircraft) : _aircraft(std::move(aircraft)) {}

    void Add(const Uav::Detections &frame);
    // The targets as they are at that time.
    void Report(double gpsTimeS, Uav::Targets &targets) const;
    std::uint64_t Dropped() const { return _dropped; }

private:
    struct Item
    {
        TargetFilter Filter;
        std::string FoundBy;
        std::uint32_t Number = 0;    // 0: tentative
        std::deque<double> SeenS{};  // while it is tentative
        double LastS = 0;
        double OwnS = 0;
        std::uint32_t Count = 0;
        std::uint32_t OwnCount = 0;
        std::vector<std::string> SeenBy{};
    };
    struct Sighting
    {
        TargetFilter::Place Place;
        double SigmaM = 0;
        bool Used = false;
    };

    bool Accept(const Uav::Detections &frame);
    std::vector<Sighting> SightingsOf(const Uav::Detections &frame);
    void Match(std::vector<Sighting> &sightings, const Uav::Detections &frame);
    void Count(Item &item, const Uav::Detections &frame);
    void Confirm();
    bool IsKnown(const Item &tentative) const;
    void Forget();
    Uav::Target ToMessage(const Item &item, double gpsTimeS) const;

    const std::string _aircraft;
    std::optional<GeoPoint> _origin;  // of the metres; where the first frame was taken
    std::vector<Item> _items;
    std::uint32_t _lastNumber = 0;
    double _newestS = 0;
    std::uint64_t _dropped = 0;
};

}  // namespace Swarm
