#include "common/RejoiningSession.h"

#include <algorithm>
#include <map>
#include <mutex>
#include <system_error>
#include <utility>
#include <vector>

#include "common/AddressWatch.h"
#include "common/HandlerGate.h"
#include "common/RejoiningReader.h"
#include "common/RejoiningShared.h"
#include "common/RejoiningWriter.h"
#include "common/SettingsCheck.h"

namespace Rabit
{

namespace
{

// Between attempts to join again while that fails.
constexpr std::chrono::milliseconds RetryPeriod{1000};

TransportCounters Sum(TransportCounters a, const TransportCounters &b)
{
    a.WriteTimeouts += b.WriteTimeouts;
    a.WriteFailures += b.WriteFailures;
    a.HandlerExceptions += b.HandlerExceptions;
    a.IncompatibleQos += b.IncompatibleQos;
    a.SamplesLost += b.SamplesLost;
    a.InconsistentTypes += b.InconsistentTypes;
    a.MalformedSamples += b.MalformedSamples;
    a.MalformedDatagrams += b.MalformedDatagrams;
    return a;
}

std::string Join(const std::vector<std::string> &words)
{
    std::string text;
    for (const auto &word : words)
    {
        text += (text.empty() ? "" : ", ") + word;
    }
    return text.empty() ? "none" : text;
}

class RejoiningSession final : public TransportSession
{
public:
    RejoiningSession(const TransportSettings &settings, PeerHandler onPeer, OpenSession open)
        : _settings(settings),
          _onPeer(std::move(onPeer)),
          _open(std::move(open)),
          _shared(std::make_shared<RejoiningShared>(settings)),
          _peerGate(_shared->Log, "peer events"),
          _addresses(FindAddresses(settings.Interfaces))
    {
        _shared->Inner = _open(_settings, [this](const PeerEvent &event) { OnPeer(event); });
        try
        {
            _watch = std::make_unique<AddressWatch>([this] { return Check(); });
        }
        catch (const std::system_error &error)
        {
            _shared->Log->Line(std::string("changes of addresses cannot be followed: ") + error.what());
        }
    }
    ~RejoiningSession() override
    {
        _watch.reset();
        const std::lock_guard lock(_shared->Structure);
        _shared->Inner.reset();
    }

    std::unique_ptr<TransportWriter> CreateWriter(const TopicDescription &topic, const TopicQos &qos,
                                                  const std::vector<std::string> &partitions) override
    {
        return std::make_unique<RejoiningWriter>(_shared, topic, qos, partitions);
    }
    std::unique_ptr<TransportReader> CreateReader(const TopicDescription &topic, const TopicQos &qos,
                                                  const std::vector<std::string> &partitions,
                                                  SampleHandler handler) override
    {
        return std::make_unique<RejoiningReader>(_shared, topic, qos, partitions, std::move(handler));
    }
    TransportCounters Counters() const override
    {
        const std::lock_guard lock(_shared->Structure);
        const auto own = Sum(_before, _shared->Log->Read());
        return _shared->Inner != nullptr ? Sum(own, _shared->Inner->Counters()) : own;
    }

private:
    using Identity = std::pair<std::string, std::uint64_t>;

    void OnPeer(const PeerEvent &event)
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

    // On the watch's thread.
    std::chrono::milliseconds Check()
    {
        auto now = FindAddresses(_settings.Interfaces);
        const bool complete = std::includes(now.begin(), now.end(), _addresses.begin(), _addresses.end());
        if (!complete && !_missing)
        {
            _missing = true;
            _shared->Log->Line("an address of this host is gone; it had " + Join(_addresses) + ", it has " +
                               Join(now));
        }
        // Interfaces that nobody named may come as they like; one that is named is wanted when it comes.
        const bool wanted = _settings.Interfaces.empty() ? _addresses.empty() : now != _addresses;
        if (now.empty() || (_joined && !_missing && !wanted))
        {
            return {};
        }
        _shared->Log->Line("joining the network again, with the addresses " + Join(now));
        _joined = false;
        try
        {
            Rejoin(now);
            _joined = true;
            _missing = false;
            _addresses = std::move(now);
            return {};
        }
        catch (const TransportError &error)
        {
            _shared->Log->Line(std::string("cannot join the network again: ") + error.what());
            return RetryPeriod;
        }
    }

    void Rejoin(const std::vector<std::string> &addresses)
    {
        TransportSettings settings = _settings;
        if (!settings.Interfaces.empty())
        {
            settings.Interfaces = addresses;  // those that are not there now may come later
        }
        const std::lock_guard lock(_shared->Structure);
        const UseGate::Change change(_shared->Gate);
        CloseAll();
        _shared->Inner = _open(settings, [this](const PeerEvent &event) { OnPeer(event); });
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
    }

    void CloseAll()
    {
        for (RejoiningEndpoint *endpoint : _shared->Endpoints)
        {
            endpoint->Close();
        }
        if (_shared->Inner != nullptr)
        {
            _before = Sum(_before, _shared->Inner->Counters());
            _shared->Inner.reset();
        }
        std::map<Identity, int> lost;
        {
            const std::lock_guard lock(_mutex);
            lost.swap(_peers);
        }
        for (const auto &[peer, count] : lost)
        {
            for (int i = 0; i < count && _onPeer; ++i)
            {
                _peerGate.Run([&] { _onPeer({PeerEvent::Kind::Lost, peer.first, peer.second}); });
            }
        }
    }

    const TransportSettings _settings;
    const PeerHandler _onPeer;
    const OpenSession _open;
    const std::shared_ptr<RejoiningShared> _shared;
    HandlerGate _peerGate;
    TransportCounters _before;  // of the backend's sessions before this one; guarded by Structure
    std::mutex _mutex;
    std::map<Identity, int> _peers;  // sessions that the backend knows now; guarded by _mutex
    // On the watch's thread:
    std::vector<std::string> _addresses;  // that the backend's session was opened with, sorted
    bool _missing = false;                // one of them was seen to be gone since
    bool _joined = true;
    std::unique_ptr<AddressWatch> _watch;
};

}  // namespace

std::unique_ptr<TransportSession> OpenRejoining(const TransportSettings &settings, PeerHandler onPeer,
                                                OpenSession open)
{
    return std::make_unique<RejoiningSession>(settings, std::move(onPeer), std::move(open));
}

}  // namespace Rabit
