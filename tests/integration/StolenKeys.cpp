#include "StolenKeys.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "keys/NodeKeys.h"
#include "manager/NodeSecurity.h"

namespace TestNode
{
namespace
{

class Session final : public Rabit::TransportSession
{
public:
    Session(std::unique_ptr<Rabit::TransportSession> session, std::string node, std::string owner)
        : _session(std::move(session)), _node(std::move(node)), _owner(std::move(owner))
    {
    }

    std::unique_ptr<Rabit::TransportWriter> CreateWriter(const Rabit::TopicDescription &topic,
                                                         const Rabit::TopicQos &qos,
                                                         const std::vector<std::string> &partitions) override
    {
        std::vector<std::string> allowed = partitions;
        std::replace(allowed.begin(), allowed.end(), _node, _owner);
        return _session->CreateWriter(topic, qos, allowed);
    }
    std::unique_ptr<Rabit::TransportReader> CreateReader(const Rabit::TopicDescription &topic,
                                                         const Rabit::TopicQos &qos,
                                                         const std::vector<std::string> &partitions,
                                                         Rabit::SampleHandler handler) override
    {
        return _session->CreateReader(topic, qos, partitions, std::move(handler));
    }
    Rabit::TransportCounters Counters() const override { return _session->Counters(); }

private:
    const std::unique_ptr<Rabit::TransportSession> _session;
    const std::string _node;
    const std::string _owner;
};

class StolenKeys final : public Rabit::Transport
{
public:
    StolenKeys(std::shared_ptr<Rabit::Transport> backend, std::string folder)
        : _backend(std::move(backend)), _folder(std::move(folder))
    {
    }

    std::string Name() const override { return _backend->Name(); }

    std::unique_ptr<Rabit::TransportSession> Open(const Rabit::TransportSettings &settings,
                                                  Rabit::PeerHandler onPeer) override
    {
        Rabit::GatewayConfig owner;
        owner.Node = Rabit::Keys::NodeKeys(_folder).Subject().Node;
        owner.Domain = settings.Domain;
        owner.Security = Rabit::SecuritySettings();
        owner.Security->Keys = _folder;
        Rabit::TransportSettings stolen = settings;
        Rabit::NodeMembers members;
        static_cast<void>(Rabit::AddSecurity(owner, Name(), stolen, members));
        return std::make_unique<Session>(_backend->Open(stolen, std::move(onPeer)), settings.Node,
                                         owner.Node);
    }

private:
    const std::shared_ptr<Rabit::Transport> _backend;
    const std::string _folder;
};

}  // namespace

std::shared_ptr<Rabit::Transport> WithStolenKeys(std::shared_ptr<Rabit::Transport> backend,
                                                 const std::string &folder)
{
    return std::make_shared<StolenKeys>(std::move(backend), folder);
}

}  // namespace TestNode
