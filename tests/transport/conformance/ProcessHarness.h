// The harness of a backend with a real network: loopback, a DDS domain of the test's own, real time.
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include "../common/TestMembers.h"
#include "DomainLease.h"
#include "TransportHarness.h"

namespace Rabit::Conformance
{

class ProcessHarness final : public TransportHarness
{
public:
    // `fleet`: all nodes are members of that fleet, also the remote ones. Empty: they have no keys.
    explicit ProcessHarness(std::unique_ptr<Transport> backend, std::string fleet = "");

    Transport &Backend() override { return *_backend; }
    TransportSettings SettingsFor(const std::string &node, std::uint64_t incarnation) override;
    bool Until(const std::function<bool()> &condition) override;
    std::size_t MostAdded() const override;
    std::unique_ptr<RemoteNode> StartRemote(const std::string &node, std::uint64_t incarnation) override;

private:
    const DomainLease _domain;
    const std::unique_ptr<Transport> _backend;
    const std::string _fleet;
    std::optional<TestMembers> _members;
};

}  // namespace Rabit::Conformance
