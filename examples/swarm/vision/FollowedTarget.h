#pragma once

#include "TargetFilter.h"
#include "uav.idl.h"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace Swarm
{

// One of the targets of a TargetTable: its place, its names, and the aircraft that have seen it. Not
// thread-safe.
struct FollowedTarget
{
    static constexpr std::size_t MaxSeers = 32;
    static constexpr std::size_t MaxFormerly = 8;

    std::uint64_t Id;  // within the table, never used again
    TargetFilter Filter;
    std::string FoundBy;
    double FirstS = 0;
    std::optional<TargetFilter::Place> FirstPlace{};  // not set if only other aircraft saw it then
    double LastS = 0;
    double OwnS = 0;
    std::uint32_t Count = 0;
    std::uint32_t OwnCount = 0;
    std::vector<std::string> SeenBy{};

    std::deque<double> SeenS{};             // while it is tentative
    std::optional<double> ConfirmedS{};     // not set: tentative
    std::optional<Uav::TargetName> Name{};  // a confirmed target gets one
    std::vector<Uav::TargetName> Formerly{};

    double ToldS = -std::numeric_limits<double>::infinity();   // when this aircraft last sent it to the
                                                               // others
    double HeardS = -std::numeric_limits<double>::infinity();  // when another aircraft last sent it
    bool HasNews = false;                                      // its names may be unknown to the others

    // Notes that the camera of aircraft `by` has seen it. `own`: it is this aircraft's camera.
    void NoteSighting(const std::string &by, double timeS, bool own);
    void AddSeer(const std::string &aircraft);
    bool IsCalled(const Uav::TargetName &name) const;
    // Adds a name of the target; the oldest one holds. Returns true if the name is new.
    bool AddName(const Uav::TargetName &name);
    // Merges the data of the other target, which is the same one, followed at the same time or earlier.
    void Merge(const FollowedTarget &other);
};

}  // namespace Swarm
