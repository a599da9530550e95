#pragma once

#include <rabit/simulated/SimulatedNetwork.h>
#include <rabit/transport/FleetMember.h>

#include <memory>
#include <string>

namespace Rabit
{

namespace Envelope
{
class NamedKeys;
}

// The keys of a fleet on a SimulatedNetwork, made in memory. They follow from names, so everybody can make
// them: for tests alone. Members of one fleet hear each other. A node without keys, or with those of a fleet
// of another name, is not heard, and hears nothing.
//
// A member belongs into SecuritySettings::Member, or into TransportSettings::Member. Not thread-safe.
class SimulatedKeys
{
public:
    explicit SimulatedKeys(const SimulatedNetwork &network, const std::string &fleet = "fleet");
    ~SimulatedKeys();
    SimulatedKeys(const SimulatedKeys &) = delete;
    SimulatedKeys &operator=(const SimulatedKeys &) = delete;

    // Returns the membership of a node that may write and read every topic. Each call makes a new one with
    // the same keys, as each start of a program does. Its problems last by the network's time. Throws
    // TransportError if the name is none of a node, or if OpenSSL fails.
    std::shared_ptr<FleetMember> Member(const std::string &node);

private:
    const std::shared_ptr<Simulated::NetworkCore> _core;
    const std::unique_ptr<Envelope::NamedKeys> _keys;
};

}  // namespace Rabit
