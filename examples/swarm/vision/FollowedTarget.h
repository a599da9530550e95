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

// One of the targets of a TargetTable: where it is, what it is called, and who has seen it. Not thread-safe.
struct FollowedTarget
{
    static constexpr std::size_t MaxSeers = 32;
    static constexpr std::size_t MaxFormerly = 8;

    std::uint64_t Id;  // within the table, never used again
    TargetFilter Filter;
    std::string FoundBy;
    double FirstS = 0;
    std::optional<TargetFilter::Place> FirstPlace{};  // not set if only others have seen it then
    double LastS = 0;
    double OwnS = 0;
    std::uint32_t Count = 0;
    std::uint32_t OwnCount = 0;
    std::vector<std::string> SeenBy{};

    std::deque<double> SeenS{};             // while it is tentative
    std::optional<double> ConfirmedS{};     // not set: tentative
    std::optional<Uav::TargetName> Name{};  // one that is not tentative gets one
    std::vector<Uav::TargetName> Formerly{};

    double ToldS = -std::numeric_limits<double>::infinity();   // when this aircraft told the others of it
    double HeardS = -std::numeric_limits<double>::infinity();  // when another one told
    bool HasNews = false;                                      // of its names, which the others may not know

    // That camera has seen it. `own`: it is this aircraft's.
    void NoteSighting(const std::string &by, double timeS, bool own);
    void AddSeer(const std::string &aircraft);
    bool IsCalled(const Uav::TargetName &name) const;
    // It has this name as well; the oldest one holds. Returns whether that was new.
    bool AddName(const Uav::TargetName &name);
    // The other one is the same target, followed at the same time or before.
    void Merge(const FollowedTarget &other);
};

}  // namespace Swarm
