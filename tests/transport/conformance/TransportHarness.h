// A backend, as the conformance suite uses it.
#pragma once

#include <rabit/transport/Transport.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <ostream>
#include <string>

namespace Rabit::Conformance
{

// A node outside of the test's process, or its stand-in. It has written one sample with key 7 and text
// "remote" on the topic KeyedText, with the state QoS.
class RemoteNode
{
public:
    virtual ~RemoteNode() = default;  // ends it, if it lives
    // Makes it vanish without a word.
    virtual void Kill() = 0;
};

// One backend, and one network that no other test is on.
class TransportHarness
{
public:
    virtual ~TransportHarness() = default;

    virtual Transport &Backend() = 0;
    // Settings for a node in this test's network.
    virtual TransportSettings SettingsFor(const std::string &node, std::uint64_t incarnation) = 0;
    // Lets time pass until the condition holds. Returns false if it does not hold after a time in which
    // everything that should happen has happened, however slow the machine is.
    virtual bool Until(const std::function<bool()> &condition) = 0;
    // The most bytes that the keys of the nodes add to a datagram; 0 without keys.
    virtual std::size_t MostAdded() const { return 0; }
    // Starts a node elsewhere.
    virtual std::unique_ptr<RemoteNode> StartRemote(const std::string &node, std::uint64_t incarnation) = 0;
};

// The parameter of the suite.
struct HarnessMaker
{
    std::string Name;  // of the backend
    std::unique_ptr<TransportHarness> (*Make)();

    friend std::ostream &operator<<(std::ostream &out, const HarnessMaker &maker)
    {
        return out << maker.Name;
    }
};

}  // namespace Rabit::Conformance
