#pragma once

#include <gtest/gtest.h>
#include <rabit/gateway/Claims.h>
#include <rabit/gateway/SharedTable.h>
#include <rabit/testing/SimulatedFleet.h>

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace Rabit
{

using Names = std::vector<std::string>;

inline const Names FiveMembers = {"ground", "uav1", "uav2", "uav3", "uav4"};
// After a start voters abstain for their lease.
inline constexpr std::chrono::milliseconds FirstLease{2100};

inline GatewayConfig MemberConfig(const std::string &node, const Names &members = FiveMembers)
{
    GatewayConfig config;
    config.Node = node;
    config.Agreement.emplace().Members = members;
    return config;
}

// A fleet with claims and a table at each node. While it runs, no claim has two holders, and fences rise.
class AgreementFleet : public ::testing::Test
{
protected:
    struct Program
    {
        explicit Program(GatewayConfig &config) : Own(config), Table(config) {}
        Claims Own;
        SharedTable Table;
    };

    SimulatedNode &Start(const GatewayConfig &config)
    {
        return fleet.Add(config, [this](SimulatedNode & /*node*/, GatewayConfig &completed)
                         { programs[completed.Node] = std::make_unique<Program>(completed); });
    }
    void StartFive()
    {
        for (const std::string &name : FiveMembers)
        {
            Start(MemberConfig(name));
        }
    }
    void Kill(const std::string &node)
    {
        fleet.Kill(node);
        programs.erase(node);
    }

    Claims &ClaimsOf(const std::string &node) { return programs.at(node)->Own; }
    SharedTable &TableOf(const std::string &node) { return programs.at(node)->Table; }

    Names HoldersOf(const std::string &claim) const
    {
        Names holders;
        for (const auto &[name, program] : programs)
        {
            if (program->Own.StillMine(claim))
            {
                holders.push_back(name);
            }
        }
        return holders;
    }

    static constexpr std::chrono::milliseconds Step{10};
    // Looks at the claims after each step.
    void RunFor(std::chrono::milliseconds duration)
    {
        for (std::chrono::milliseconds run{0}; run < duration; run += Step)
        {
            fleet.RunFor(Step);
            for (const std::string &claim : watched)
            {
                const Names holders = HoldersOf(claim);
                ASSERT_LE(holders.size(), 1u) << claim << ": " << holders.front() << ", " << holders.back();
                if (!holders.empty())
                {
                    Note(claim, holders.front());
                }
            }
        }
    }
    // Returns the holder, or an empty text if there is none within that time.
    std::string UntilHeld(const std::string &claim, std::chrono::milliseconds most)
    {
        for (std::chrono::milliseconds run{0}; run < most && HoldersOf(claim).empty(); run += Step)
        {
            RunFor(Step);
        }
        const Names holders = HoldersOf(claim);
        return holders.empty() ? "" : holders.front();
    }

    void Cut(const std::string &node)
    {
        fleet.Network.SetFaults(node, "*", {.Cut = true});
        fleet.Network.SetFaults("*", node, {.Cut = true});
    }

    // Cuts both directions between the first ones and the others.
    void Divide(const Names &one, const Names &other)
    {
        for (const std::string &from : one)
        {
            for (const std::string &to : other)
            {
                fleet.Network.SetFaults(from, to, {.Cut = true});
                fleet.Network.SetFaults(to, from, {.Cut = true});
            }
        }
    }

    std::uint64_t BytesOf(const std::string &node) const { return fleet.Network.Sent(node).Bytes; }

    SimulatedFleet fleet;
    std::map<std::string, std::unique_ptr<Program>> programs;
    Names watched = {"leader", "cell 17"};
    std::map<std::string, std::uint64_t> fences;

private:
    void Note(const std::string &claim, const std::string &holder)
    {
        const std::optional<std::uint64_t> fence = ClaimsOf(holder).FenceOf(claim);
        ASSERT_TRUE(fence.has_value());
        const bool isNew = std::exchange(_holders[claim], holder) != holder;
        EXPECT_TRUE(!isNew || *fence > fences[claim]) << claim << " of " << holder;
        EXPECT_GE(*fence, fences[claim]);
        fences[claim] = *fence;
    }

    std::map<std::string, std::string> _holders;
};

}  // namespace Rabit
