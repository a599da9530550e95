#include "SimulatedHarness.h"

#include <thread>

#include "../conformance/TestSample.h"
#include "envelope/Sealer.h"

namespace Rabit::Conformance
{

namespace
{

class SimulatedRemote final : public RemoteNode
{
public:
    SimulatedRemote(SimulatedNetwork &network, std::unique_ptr<TransportSession> session, std::string node)
        : _network(network), _session(std::move(session)), _node(std::move(node))
    {
        _writer = _session->CreateWriter(KeyedTopic(), State(), {});
        _writer->Write(MakeSample(7, "remote"), 1);
    }
    void Kill() override { _network.CrashNode(_node); }

private:
    SimulatedNetwork &_network;
    std::unique_ptr<TransportSession> _session;
    std::unique_ptr<TransportWriter> _writer;
    const std::string _node;
};

}  // namespace

SimulatedHarness::SimulatedHarness(std::uint64_t seed, const std::string &fleet)
    : _network(seed), _backend(_network)
{
    if (!fleet.empty())
    {
        _members.emplace(fleet);
    }
}

std::size_t SimulatedHarness::MostAdded() const
{
    return _members ? Envelope::Sealer::MostAdded : 0;
}

TransportSettings SimulatedHarness::SettingsFor(const std::string &node, std::uint64_t incarnation)
{
    TransportSettings settings;
    settings.Node = node;
    settings.Incarnation = incarnation;
    settings.Memory = settings.Lease = std::chrono::seconds(3);
    settings.AnnouncementPeriod = std::chrono::seconds(1);
    if (_members)
    {
        settings.Member = _members->Member(node);
    }
    return settings;
}

bool SimulatedHarness::Until(const std::function<bool()> &condition)
{
    const auto end = _network.Now() + std::chrono::seconds(60);
    while (!condition())
    {
        if (_network.Now() > end)
        {
            return false;
        }
        Pass(std::chrono::milliseconds(1));
        std::this_thread::yield();  // some tests have threads that write meanwhile
    }
    return true;
}

std::unique_ptr<RemoteNode> SimulatedHarness::StartRemote(const std::string &node, std::uint64_t incarnation)
{
    return std::make_unique<SimulatedRemote>(_network, _backend.Open(SettingsFor(node, incarnation), {}),
                                             node);
}

}  // namespace Rabit::Conformance
