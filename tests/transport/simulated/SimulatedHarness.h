#pragma once

#include <rabit/simulated/SimulatedNetwork.h>
#include <rabit/simulated/SimulatedTransport.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "../common/TestMembers.h"
#include "../conformance/TransportHarness.h"

namespace Rabit::Conformance
{

// A simulated network, whose time this harness advances.
class SimulatedHarness final : public TransportHarness
{
public:
    // `fleet`: all nodes are members of that fleet. Empty: they have no keys.
    explicit SimulatedHarness(std::uint64_t seed = 1, const std::string &fleet = "");

    Transport &Backend() override { return _backend; }
    SimulatedNetwork &Network() { return _network; }
    TransportSettings SettingsFor(const std::string &node, std::uint64_t incarnation) override;
    // Advances by one millisecond at a time, at most 60 simulated seconds.
    bool Until(const std::function<bool()> &condition) override;
    std::size_t MostAdded() const override;
    // Lets simulated time pass.
    void Pass(std::chrono::nanoseconds time) { _network.AdvanceTo(_network.Now() + time); }
    std::unique_ptr<RemoteNode> StartRemote(const std::string &node, std::uint64_t incarnation) override;

private:
    SimulatedNetwork _network;
    SimulatedTransport _backend;
    std::optional<TestMembers> _members;
};

}  // namespace Rabit::Conformance
