#include <rabit/simulated/SimulatedNetwork.h>

#include "NetworkCore.h"

namespace Rabit
{

SimulatedNetwork::SimulatedNetwork(std::uint64_t seed, const SimulatedTimings &timings)
    : _core(std::make_shared<Simulated::NetworkCore>(seed, timings))
{
}

SimulatedNetwork::~SimulatedNetwork() = default;

void SimulatedNetwork::SetFaults(const std::string &from, const std::string &to,
                                 const SimulatedFaults &faults)
{
    _core->SetFaults(from, to, faults);
}

void SimulatedNetwork::ClearFaults()
{
    _core->ClearFaults();
}

void SimulatedNetwork::SetMedium(const std::string &nodes, const SimulatedMedium &medium)
{
    _core->SetMedium(nodes, medium);
}

SimulatedAir SimulatedNetwork::Air(const std::string &nodes) const
{
    return _core->Air(nodes);
}

SimulatedSent SimulatedNetwork::Sent(const std::string &node) const
{
    return _core->Sent(node);
}

std::chrono::nanoseconds SimulatedNetwork::Now() const
{
    return _core->Now();
}

std::optional<std::chrono::nanoseconds> SimulatedNetwork::NextEvent() const
{
    return _core->NextEvent();
}

void SimulatedNetwork::AdvanceTo(std::chrono::nanoseconds time)
{
    _core->AdvanceTo(time);
}

void SimulatedNetwork::CrashNode(const std::string &node)
{
    _core->CrashNode(node);
}

std::optional<std::chrono::nanoseconds> SimulatedNetwork::LastArrival(const std::string &from,
                                                                      const std::string &to,
                                                                      const std::string &topic) const
{
    return _core->LastArrival(from, to, topic);
}

SimulatedTraffic SimulatedNetwork::Traffic() const
{
    return _core->Traffic();
}

}  // namespace Rabit
