// The harness of a backend with a real network: loopback, a DDS domain of the test's own, real time.
#pragma once

#include <chrono>
#include <memory>
#include <string>

#include "DomainLease.h"
#include "TransportHarness.h"

namespace Rabit::Conformance
{

class ProcessHarness final : public TransportHarness
{
public:
    explicit ProcessHarness(std::unique_ptr<Transport> backend) : _backend(std::move(backend)) {}

    Transport &Backend() override { return *_backend; }
    TransportSettings SettingsFor(const std::string &node, std::uint64_t incarnation) override;
    bool Until(const std::function<bool()> &condition) override;
    std::unique_ptr<RemoteNode> StartRemote(const std::string &node, std::uint64_t incarnation) override;

private:
    const DomainLease _domain;
    const std::unique_ptr<Transport> _backend;
};

}  // namespace Rabit::Conformance
