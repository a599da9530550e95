// A session that joins the network when there is one. It joins anew when the host's networks change in a way
// that matters (see RejoinDecision).
//
// Neither vendor follows a change of networks: a participant's announced addresses are fixed when it is made.
// So the backend's session is closed and opened again, with all its writers and readers. Their holders notice
// only the effects that Transport.h describes.
#pragma once

#include <rabit/transport/Transport.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/AddressWatch.h"
#include "common/DuplicateAddresses.h"
#include "common/HandlerGate.h"
#include "common/HostNetworks.h"
#include "common/NetworkChoice.h"
#include "common/RejoinDecision.h"
#include "common/RejoiningBackend.h"
#include "common/RejoiningShared.h"
#include "common/SendingTurn.h"

namespace Rabit
{

class RejoiningSession final : public TransportSession
{
public:
    // Access to the host. Called on the thread that calls Look(); the functions must outlive the session.
    struct Host
    {
        // nullopt: they cannot be listed now.
        std::function<std::optional<std::vector<HostNetwork>>()> Networks;
        std::function<std::chrono::steady_clock::time_point()> Now;
        // Returns the address of a peer's name, if it is known now.
        std::function<std::optional<std::string>(const std::string &name)> AddressOf;
    };

    // Joins the network if there is one. Throws TransportError for impossible settings, and if the backend
    // does not open although there is a network.
    RejoiningSession(const TransportSettings &settings, PeerHandler onPeer,
                     std::shared_ptr<RejoiningBackend> backend, Host host);
    ~RejoiningSession() override;

    // Looks at the host, and joins the network anew if that is due. Returns the time after which to look
    // again even if no change is reported. Must not run twice at once.
    std::optional<std::chrono::milliseconds> Look();

    std::unique_ptr<TransportWriter> CreateWriter(const TopicDescription &topic, const TopicQos &qos,
                                                  const std::vector<std::string> &partitions) override;
    std::unique_ptr<TransportReader> CreateReader(const TopicDescription &topic, const TopicQos &qos,
                                                  const std::vector<std::string> &partitions,
                                                  SampleHandler handler) override;
    TransportCounters Counters() const override { return _shared->Log->Read(); }
    std::vector<RemoteEndpoint> RemoteEndpointsOn(const std::string &topic) const override
    {
        return _shared->Topics->RemoteOn(topic);
    }
    std::vector<std::string> RemoteTopics() const override { return _shared->Topics->RemoteTopics(); }
    std::vector<SettingsProblem> NetworkProblems() const override;
    DiscoveryTurns *Discovery() override { return _turns.get(); }
    bool BeginTurn(std::size_t mostBytes) override;
    TurnDestinations TakeTurnDestinations() override { return _sending->TakeDestinations(); }
    void EndTurn() override;

    // Starts a thread of the session that calls Look() whenever the kernel reports a change.
    void Watch();

private:
    using Identity = std::pair<std::string, std::uint64_t>;

    // The settings for the backend, reduced to the interfaces and peers that are present now.
    struct Current
    {
        std::vector<HostNetwork> Host;
        std::vector<HostNetwork> Usable;
        TransportSettings Settings;
    };

    // Lists the present networks and peers; NetworkProblems reports the missing ones from then on.
    // nullopt: the networks cannot be listed now, which NetworkProblems reports.
    std::optional<Current> See(const std::vector<PeerPlace> &peers);
    void LeaveOutDuplicates(const std::vector<PeerPlace> &peers, NetworkChoice &choice);
    std::vector<PeerPlace> PeerPlaces() const;
    void OnPeer(const PeerEvent &event);
    void Open(const Current &current);
    void Rejoin(const Current &current, const std::string &why);
    void Fail(const std::string &setting, const std::string &why);
    void CloseAll();

    const TransportSettings _settings;
    const bool _hasOwnNetworks;
    const PeerHandler _onPeer;
    const std::shared_ptr<RejoiningBackend> _backend;
    const Host _host;
    const std::shared_ptr<RejoiningShared> _shared;
    const std::shared_ptr<DiscoveryTurns> _turns = std::make_shared<DiscoveryTurns>();
    const std::shared_ptr<SendingTurn> _sending = std::make_shared<SendingTurn>();
    std::uint64_t _turnOf = 0;  // RejoiningShared::Left, when the turn began; for its thread alone
    HandlerGate _peerGate;
    mutable std::mutex _mutex;
    std::map<Identity, int> _peers;          // sessions that the backend knows now; guarded by _mutex
    std::vector<SettingsProblem> _problems;  // guarded by _mutex
    // Used only by Look():
    RejoinDecision _decision;
    DuplicateAddresses _duplicates;
    std::vector<std::string> _openedPeers;    // the backend's session was opened with these
    std::optional<SettingsProblem> _failure;  // of the last attempt to join
    std::unique_ptr<AddressWatch> _watch;  // the last member, so that Look() has ended before the others go
};

// Opens a RejoiningSession on this host, which follows its changes. Throws TransportError.
std::unique_ptr<TransportSession> OpenRejoining(const TransportSettings &settings, PeerHandler onPeer,
                                                std::shared_ptr<RejoiningBackend> backend);

// Transport::Check of a backend with RejoiningSession.
std::vector<SettingsProblem> CheckRejoining(const TransportSettings &settings,
                                            const RejoiningBackend &backend);

}  // namespace Rabit
