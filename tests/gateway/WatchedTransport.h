#pragma once

#include <rabit/transport/Transport.h>

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace Rabit
{

// A transport whose session's counters a test may read. For one session at a time.
class WatchedTransport final : public Transport
{
public:
    explicit WatchedTransport(std::shared_ptr<Transport> inner) : _inner(std::move(inner)) {}

    std::string Name() const override { return _inner->Name(); }
    std::unique_ptr<TransportSession> Open(const TransportSettings &settings, PeerHandler onPeer) override
    {
        auto session = std::make_unique<Session>(*this, _inner->Open(settings, std::move(onPeer)));
        _session = session.get();
        return session;
    }

    // Of the session that is open.
    TransportCounters Counters() const { return _session->Counters(); }
    // Bytes on the air so far.
    std::uint64_t Bytes() const
    {
        const TransportCounters counters = Counters();
        return counters.DiscoveryBytes + counters.SampleBytes;
    }

private:
    class Session final : public TransportSession
    {
    public:
        Session(WatchedTransport &owner, std::unique_ptr<TransportSession> inner)
            : _owner(owner), _inner(std::move(inner))
        {
        }
        ~Session() override { _owner._session = nullptr; }
        std::unique_ptr<TransportWriter> CreateWriter(const TopicDescription &topic, const TopicQos &qos,
                                                      const std::vector<std::string> &partitions) override
        {
            return _inner->CreateWriter(topic, qos, partitions);
        }
        std::unique_ptr<TransportReader> CreateReader(const TopicDescription &topic, const TopicQos &qos,
                                                      const std::vector<std::string> &partitions,
                                                      SampleHandler handler) override
        {
            return _inner->CreateReader(topic, qos, partitions, std::move(handler));
        }
        TransportCounters Counters() const override { return _inner->Counters(); }

    private:
        WatchedTransport &_owner;
        const std::unique_ptr<TransportSession> _inner;
    };

    const std::shared_ptr<Transport> _inner;
    Session *_session = nullptr;
};

}  // namespace Rabit
