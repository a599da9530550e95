#pragma once

#include <rabit/base/Fnv1a.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace Rabit
{

// Settings of an agreement. All members need the same list and the same lease: two lists may have majorities
// without a common member.
struct AgreementSettings
{
    using Duration = std::chrono::nanoseconds;

    // Bounds what one claimant costs a voter, and what one request holds.
    static constexpr std::size_t MostMembers = 64;
    static constexpr std::size_t MostClaims = 64;   // of one node
    static constexpr std::size_t LongestName = 64;  // of a claim, in bytes

    std::string Self;
    // Another one for each start of the node, rising.
    std::uint64_t Incarnation = 0;
    // The names of all nodes that vote, each once, in any order.
    std::vector<std::string> Members{};
    // How long a holder may hold without an answer. At least four of the slowest beats.
    Duration Lease = std::chrono::seconds(2);
    // Answers to renewals ride in the beats of this node. A node with several paths answers with datagrams,
    // since the beats of another path might not come.
    bool RidesInBeats = true;

    // How long a voter keeps a claim for its holder, counted from when the renewal came. The holder counts
    // `Lease` from when it sent that renewal. Both clocks may be wrong by 1 % each, in opposite directions:
    // 1.03 / 1.01 > 1 / 0.99.
    Duration VotersLease() const { return Lease + Lease * 3 / 100; }
    std::size_t Majority() const { return Members.size() / 2 + 1; }
    bool IsMember(std::string_view name) const
    {
        return std::find(Members.begin(), Members.end(), name) != Members.end();
    }
    // Tells lists and leases apart. Each request and reply carries it.
    std::uint64_t Group() const
    {
        std::vector<std::string> names = Members;
        std::sort(names.begin(), names.end());
        Fnv1a hash;
        hash.AddNumber(static_cast<std::uint64_t>(Lease.count()));
        for (const std::string &name : names)
        {
            hash.Add(name).AddByte(0);
        }
        return hash.Sum();
    }
};

}  // namespace Rabit
