#include "WiredTransport.h"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace Rabit::Bench
{

struct Wire::Session
{
    std::string Node;
    std::uint64_t Incarnation = 0;
    PeerHandler OnPeer;
};

struct Wire::Reader
{
    const Session *Owner = nullptr;
    std::string Topic;
    std::vector<std::string> Partitions;
    SampleHandler Handler;
};

namespace
{

bool Match(const std::vector<std::string> &writes, const std::vector<std::string> &reads)
{
    return std::any_of(
        reads.begin(), reads.end(),
        [&writes](const std::string &name)
        { return name == "*" || std::find(writes.begin(), writes.end(), name) != writes.end(); });
}

std::vector<std::string> OrDefault(const std::vector<std::string> &partitions)
{
    return partitions.empty() ? std::vector<std::string>{""} : partitions;
}

class WiredReader final : public TransportReader
{
public:
    WiredReader(Wire &wire, Wire::Reader reader) : _wire(wire), _reader(std::move(reader))
    {
        _wire.Readers.push_back(&_reader);
    }
    ~WiredReader() override { std::erase(_wire.Readers, &_reader); }
    int MatchedWriters() const override { return 1; }

private:
    Wire &_wire;
    Wire::Reader _reader;
};

class WiredWriter final : public TransportWriter
{
public:
    WiredWriter(Wire &wire, const Wire::Session &owner, std::string topic,
                std::vector<std::string> partitions)
        : _wire(wire), _owner(owner), _topic(std::move(topic)), _partitions(std::move(partitions))
    {
    }

    WriteResult Write(const SampleEncoder &sample, std::int64_t sourceTime) override
    {
        return Send(nullptr, sample, sourceTime);
    }
    WriteResult WriteTo(const std::string &node, const SampleEncoder &sample,
                        std::int64_t sourceTime) override
    {
        return Send(&node, sample, sourceTime);
    }

    WriteResult Dispose(const SampleEncoder &, std::int64_t) override { return WriteResult::Failed; }
    int MatchedReaders() const override { return 1; }

private:
    // `to` is null: to all.
    WriteResult Send(const std::string *to, const SampleEncoder &sample, std::int64_t sourceTime)
    {
        _buffer.resize(sample.EncodedSize());
        if (!sample.Encode(_buffer))
        {
            return WriteResult::Failed;
        }
        SampleInfo info;
        info.Node = _owner.Node;
        info.Incarnation = _owner.Incarnation;
        info.SourceTime = sourceTime;
        info.Sequence = ++_sequence;
        ++_wire.Total.Writes;
        _wire.Total.WrittenBytes += _buffer.size();
        for (const Wire::Reader *reader : _wire.Readers)
        {
            if (reader->Owner != &_owner && (to == nullptr || reader->Owner->Node == *to) &&
                reader->Topic == _topic && Match(_partitions, reader->Partitions))
            {
                ++_wire.Total.Arrivals;
                _wire.Total.ArrivedBytes += _buffer.size();
                reader->Handler(_buffer, info);
            }
        }
        return WriteResult::Ok;
    }

    Wire &_wire;
    const Wire::Session &_owner;
    const std::string _topic;
    const std::vector<std::string> _partitions;
    std::vector<std::uint8_t> _buffer;
    std::uint64_t _sequence = 0;
};

class WiredSession final : public TransportSession
{
public:
    WiredSession(Wire &wire, const TransportSettings &settings, PeerHandler onPeer)
        : _wire(wire), _session{settings.Node, settings.Incarnation, std::move(onPeer)}
    {
        for (const Wire::Session *other : _wire.Sessions)
        {
            other->OnPeer({PeerEvent::Kind::Appeared, _session.Node, _session.Incarnation});
            _session.OnPeer({PeerEvent::Kind::Appeared, other->Node, other->Incarnation});
        }
        _wire.Sessions.push_back(&_session);
    }
    ~WiredSession() override
    {
        std::erase(_wire.Sessions, &_session);
        for (const Wire::Session *other : _wire.Sessions)
        {
            other->OnPeer({PeerEvent::Kind::Left, _session.Node, _session.Incarnation});
        }
    }

    std::unique_ptr<TransportWriter> CreateWriter(const TopicDescription &topic, const TopicQos &,
                                                  const std::vector<std::string> &partitions) override
    {
        return std::make_unique<WiredWriter>(_wire, _session, topic.Name, OrDefault(partitions));
    }
    std::unique_ptr<TransportReader> CreateReader(const TopicDescription &topic, const TopicQos &,
                                                  const std::vector<std::string> &partitions,
                                                  SampleHandler handler) override
    {
        return std::make_unique<WiredReader>(
            _wire, Wire::Reader{&_session, topic.Name, OrDefault(partitions), std::move(handler)});
    }
    TransportCounters Counters() const override { return {}; }

private:
    Wire &_wire;
    Wire::Session _session;
};

}  // namespace

std::unique_ptr<TransportSession> WiredTransport::Open(const TransportSettings &settings, PeerHandler onPeer)
{
    return std::make_unique<WiredSession>(_wire, settings, std::move(onPeer));
}

}  // namespace Rabit::Bench
