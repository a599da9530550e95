#include "common/RejoiningSession.h"

#include <algorithm>
#include <exception>
#include <iterator>
#include <system_error>

#include "common/PeerAddress.h"
#include "common/PeerResolver.h"
#include "common/RejoiningEndpoints.h"
#include "common/SettingsCheck.h"

namespace Rabit
{

namespace
{

using std::chrono::milliseconds;

// Interval of looks for changes that the kernel does not report: addresses of peers without one, and
// addresses that peers announce.
constexpr milliseconds PeerPeriod{500};
// Until networks that could not be listed are listed again. The kernel does not report that they can.
constexpr milliseconds ListPeriod{1000};

const TransportSettings &Checked(const TransportSettings &settings)
{
    CheckSettings(settings);
    return settings;
}

NetworkChoice Choose(const std::vector<HostNetwork> &host, TransportSettings settings, bool hasOwnNetworks,
                     const RejoiningBackend &backend)
{
    if (hasOwnNetworks)
    {
        settings.Interfaces.clear();
    }
    return ChooseNetworks(host, settings, backend.MostNetworks());
}

// The peers that have an address, as `address` or `address:port`; the others become problems.
std::vector<std::string> ResolvePeers(
    const std::vector<std::string> &peers,
    const std::function<std::optional<std::string>(const std::string &)> &addressOf,
    std::vector<SettingsProblem> &problems)
{
    std::vector<std::string> resolved;
    for (const std::string &peer : peers)
    {
        const PeerAddress parsed = ParsePeer(peer);
        const auto address = parsed.HasAddress() ? parsed.Host : addressOf(parsed.Host);
        if (address)
        {
            resolved.push_back(*address);
            if (parsed.Port != 0)
            {
                resolved.back().append(":").append(std::to_string(parsed.Port));
            }
        }
        else
        {
            problems.push_back(
                {"peers", peer, "the peer " + peer + " has no IPv4 address: looking for one", false});
        }
    }
    return resolved;
}

SettingsProblem CannotList()
{
    return {"interfaces", "", "the networks of this host cannot be listed; trying again", false};
}

std::vector<std::string> NamesToLookUp(const TransportSettings &settings)
{
    std::vector<std::string> names;
    for (const std::string &peer : settings.Peers)
    {
        if (const PeerAddress parsed = ParsePeer(peer); !parsed.HasAddress())
        {
            names.push_back(parsed.Host);
        }
    }
    return names;
}

}  // namespace

RejoiningSession::RejoiningSession(const TransportSettings &settings, PeerHandler onPeer,
                                   std::shared_ptr<RejoiningBackend> backend, Host host)
    : _settings(Checked(settings)),
      _hasOwnNetworks(backend->HasOwnNetworks(settings)),
      _onPeer(std::move(onPeer)),
      _backend(std::move(backend)),
      _host(std::move(host)),
      _shared(std::make_shared<RejoiningShared>(settings)),
      _peerGate(_shared->Log, "peer events")
{
    const std::optional<Current> current = See({});
    if (!current || (current->Usable.empty() && !_hasOwnNetworks))
    {
        _backend->CheckConfig(_settings);
        return;
    }
    const std::lock_guard lock(_shared->Structure);
    Open(*current);
}

RejoiningSession::~RejoiningSession()
{
    _watch.reset();
    const std::lock_guard lock(_shared->Structure);
    _shared->Inner.reset();
}

void RejoiningSession::Watch()
{
    try
    {
        _watch = std::make_unique<AddressWatch>([this] { return Look(); });
    }
    catch (const std::system_error &error)
    {
        _shared->Log->Line(std::string("changes of networks cannot be followed: ") + error.what());
    }
}

std::unique_ptr<TransportWriter> RejoiningSession::CreateWriter(const TopicDescription &topic,
                                                                const TopicQos &qos,
                                                                const std::vector<std::string> &partitions)
{
    return std::make_unique<RejoiningWriter>(_shared, topic, qos, partitions);
}

std::unique_ptr<TransportReader> RejoiningSession::CreateReader(const TopicDescription &topic,
                                                                const TopicQos &qos,
                                                                const std::vector<std::string> &partitions,
                                                                SampleHandler handler)
{
    return std::make_unique<RejoiningReader>(_shared, topic, qos, partitions, std::move(handler));
}

std::vector<SettingsProblem> RejoiningSession::NetworkProblems() const
{
    std::vector<SettingsProblem> problems;
    {
        const std::lock_guard lock(_mutex);
        problems = _problems;
    }
    // While the session joins the network anew, there is none that has problems.
    const std::unique_lock lock(_shared->Structure, std::try_to_lock);
    if (lock.owns_lock() && _shared->Inner != nullptr)
    {
        const auto inner = _shared->Inner->Problems();
        problems.insert(problems.end(), inner.begin(), inner.end());
    }
    return problems;
}

bool RejoiningSession::BeginTurn(std::size_t mostBytes)
{
    constexpr std::size_t Headers = 20 + 8;  // IPv4, UDP
    _turnOf = _shared->Left;
    return mostBytes > Headers && _sending->Begin(mostBytes - Headers);
}

// The kept datagrams belong to the session of the backend that was there when the turn began.
void RejoiningSession::EndTurn()
{
    const UseGate::Use use(_shared->Gate);
    use.Allowed() && _turnOf == _shared->Left ? _sending->End() : _sending->Drop();
}

std::optional<milliseconds> RejoiningSession::Look()
{
    const auto peers = PeerPlaces();
    const std::optional<Current> seen = See(peers);
    if (!seen)
    {
        return ListPeriod;
    }
    const Current &current = *seen;
    const auto now = _host.Now();
    const auto verdict =
        _decision.Look(now, {current.Host, current.Usable, peers, current.Settings.Peers != _openedPeers});
    if (verdict.Join)
    {
        Rejoin(current, verdict.Why);
        return milliseconds(0);
    }
    std::optional<milliseconds> again;
    if (verdict.Again)
    {
        // Rounded up, so that the next look is not a moment too early.
        again = std::chrono::ceil<milliseconds>(*verdict.Again - now);
    }
    const bool isLookedFor = current.Settings.Peers.size() < _settings.Peers.size();
    const bool mayHaveDuplicates = _backend->IsMisledByDuplicates() && current.Usable.size() > 1;
    if (isLookedFor || mayHaveDuplicates)
    {
        again = std::min(again.value_or(PeerPeriod), PeerPeriod);
    }
    return again;
}

void RejoiningSession::LeaveOutDuplicates(const std::vector<PeerPlace> &peers, NetworkChoice &choice)
{
    _duplicates.Look(choice.Usable, peers);
    std::erase_if(choice.Usable,
                  [&](const HostNetwork &network)
                  {
                      const bool isLeftOut = _duplicates.Has(network);
                      if (isLeftOut)
                      {
                          choice.Problems.push_back(
                              {"interfaces", network.Label,
                               "the interface " + network.Label +
                                   " is not used, because another node has its address " + network.Address +
                                   " too, on another network: name the interfaces that matter",
                               false});
                      }
                      return isLeftOut;
                  });
}

std::optional<RejoiningSession::Current> RejoiningSession::See(const std::vector<PeerPlace> &peers)
{
    auto networks = _host.Networks();
    if (!networks)
    {
        const std::lock_guard lock(_mutex);
        _problems = {CannotList()};
        return std::nullopt;
    }
    Current current;
    current.Host = std::move(*networks);
    auto choice = Choose(current.Host, _settings, _hasOwnNetworks, *_backend);
    if (_backend->IsMisledByDuplicates() && !_hasOwnNetworks)
    {
        LeaveOutDuplicates(peers, choice);
    }
    current.Usable = std::move(choice.Usable);
    current.Settings = _settings;
    current.Settings.Peers = ResolvePeers(_settings.Peers, _host.AddressOf, choice.Problems);
    const bool vendorFinds = _hasOwnNetworks || (_settings.Interfaces.empty() && _backend->FindsNetworks());
    current.Settings.Interfaces.clear();
    for (const HostNetwork &network : current.Usable)
    {
        if (!vendorFinds)
        {
            current.Settings.Interfaces.push_back(network.Address);
        }
    }
    if (_failure)
    {
        choice.Problems.push_back(*_failure);
    }
    const std::lock_guard lock(_mutex);
    _problems = std::move(choice.Problems);
    return current;
}

std::vector<PeerPlace> RejoiningSession::PeerPlaces() const
{
    const std::lock_guard lock(_shared->Structure);
    return _shared->Inner != nullptr ? _shared->Inner->PeerPlaces() : std::vector<PeerPlace>();
}

void RejoiningSession::OnPeer(const PeerEvent &event)
{
    {
        const std::lock_guard lock(_mutex);
        const Identity peer{event.Node, event.Incarnation};
        if (event.What == PeerEvent::Kind::Appeared)
        {
            ++_peers[peer];
        }
        else if (--_peers[peer] <= 0)
        {
            _peers.erase(peer);
        }
    }
    if (_onPeer)
    {
        _onPeer(event);
    }
}

void RejoiningSession::Open(const Current &current)
{
    _shared->Inner =
        _backend->Open(current.Settings, {.Log = _shared->Log,
                                          .Topics = _shared->Topics,
                                          .OnPeer = [this](const PeerEvent &event) { OnPeer(event); },
                                          .Turns = _turns,
                                          .Sending = _sending});
    _openedPeers = current.Settings.Peers;
    try
    {
        for (RejoiningEndpoint *endpoint : _shared->Endpoints)
        {
            endpoint->Open(*_shared->Inner);
        }
    }
    catch (...)
    {
        CloseAll();
        throw;
    }
    _decision.Joined(_host.Now(), current.Usable);
    _failure.reset();
}

void RejoiningSession::Rejoin(const Current &current, const std::string &why)
{
    _shared->Log->Line("joining the network anew, because " + why + "; the networks are " +
                       Describe(current.Usable));
    const auto start = _host.Now();
    const std::lock_guard lock(_shared->Structure);
    const UseGate::Change change(_shared->Gate);
    CloseAll();
    try
    {
        Open(current);
        const auto took = std::chrono::duration_cast<milliseconds>(_host.Now() - start);
        _shared->Log->Line("joined the network anew within " + std::to_string(took.count()) + " ms");
    }
    catch (const TransportError &error)
    {
        Fail(error.Setting(), error.what());
    }
    catch (const std::exception &error)
    {
        Fail("", error.what());
    }
}

void RejoiningSession::Fail(const std::string &setting, const std::string &why)
{
    _decision.Failed(_host.Now());
    _failure = SettingsProblem{setting, "", "cannot join the network: " + why, false};
}

void RejoiningSession::CloseAll()
{
    ++_shared->Left;
    for (RejoiningEndpoint *endpoint : _shared->Endpoints)
    {
        endpoint->Close();
    }
    _shared->Inner.reset();
    _shared->Topics->ForgetRemote();
    std::map<Identity, int> lost;
    {
        const std::lock_guard lock(_mutex);
        lost.swap(_peers);
    }
    for (const auto &[peer, count] : lost)
    {
        for (int i = 0; i < count && _onPeer; ++i)
        {
            _peerGate.Run(
                [this, &identity = peer] {
                    _onPeer({PeerEvent::Kind::Lost, identity.first, identity.second});
                });
        }
    }
}

std::unique_ptr<TransportSession> OpenRejoining(const TransportSettings &settings, PeerHandler onPeer,
                                                std::shared_ptr<RejoiningBackend> backend)
{
    CheckSettings(settings);
    const auto resolver = std::make_shared<PeerResolver>(NamesToLookUp(settings));
    auto session = std::make_unique<RejoiningSession>(
        settings, std::move(onPeer), std::move(backend),
        RejoiningSession::Host{&ListHostNetworks, &std::chrono::steady_clock::now,
                               [resolver](const std::string &name) { return resolver->AddressOf(name); }});
    session->Watch();
    return session;
}

std::vector<SettingsProblem> CheckRejoining(const TransportSettings &settings,
                                            const RejoiningBackend &backend)
{
    auto problems = FindImpossible(settings);
    try
    {
        backend.CheckConfig(settings);
    }
    catch (const TransportError &error)
    {
        const bool isOfFile = error.Setting() == "backend_config";
        problems.push_back({error.Setting(), isOfFile ? settings.BackendConfig : "", error.what(), true});
    }
    if (!problems.empty())
    {
        return problems;  // problems of the networks would only hide these
    }
    if (const auto networks = ListHostNetworks())
    {
        problems = Choose(*networks, settings, backend.HasOwnNetworks(settings), backend).Problems;
    }
    else
    {
        problems.push_back(CannotList());
    }
    const PeerResolver resolver(NamesToLookUp(settings));
    ResolvePeers(
        settings.Peers, [&](const std::string &name) { return resolver.AddressOf(name); }, problems);
    return problems;
}

}  // namespace Rabit
