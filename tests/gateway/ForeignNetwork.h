#pragma once

#include <rabit/transport/Transport.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "wire/MessageEncoder.h"

// A network with the programs that the test names, and one reader or writer of ours.
namespace Rabit::Foreign
{

struct Network
{
    std::vector<RemoteEndpoint> Endpoints;
    std::vector<std::string> Topics;
    SampleHandler Handler;
    std::vector<TopicQos> Readers;  // that were made, in turn
    TopicDescription Topic;
    TopicQos WriterQos;
    WriteResult Result = WriteResult::Ok;
    std::vector<std::vector<std::uint8_t>> Written;
    int Disposals = 0;
    int Readable = 1;  // readers of the topic that is written

    // Delivers a sample of a program, or of a node if `node` is not empty.
    void Deliver(const MessageType &type, const RabitMessage &message, std::uint64_t sequence,
                 std::uint8_t writer = 1, std::int64_t sourceTime = 0, const std::string &node = "")
    {
        std::vector<std::uint8_t> bytes(type.SerializedSize(message));
        type.Serialize(message, bytes);
        DeliverBytes(bytes, sequence, writer, sourceTime, node);
    }
    void DeliverBytes(const std::vector<std::uint8_t> &bytes, std::uint64_t sequence, std::uint8_t writer = 1,
                      std::int64_t sourceTime = 0, const std::string &node = "")
    {
        SampleInfo info;
        info.Writer = {writer};
        info.Sequence = sequence;
        info.SourceTime = sourceTime;
        info.Node = node;
        if (Topic.KeyOf)
        {
            Topic.KeyOf(bytes, info.Key);
        }
        Handler(bytes, info);
        LastKey = info.Key;
    }
    // Disposes the instance of the last sample.
    void End()
    {
        SampleInfo info;
        info.Writer = {1};
        info.Alive = false;
        info.Key = LastKey;
        Handler({}, info);
    }
    KeyHash LastKey{};
};

class Reader final : public TransportReader
{
public:
    int MatchedWriters() const override { return 1; }
};

class Writer final : public TransportWriter
{
public:
    explicit Writer(Network &network) : _network(network) {}
    WriteResult Write(const SampleEncoder &sample, std::int64_t) override
    {
        if (_network.Result == WriteResult::Ok)
        {
            _network.Written.emplace_back(sample.EncodedSize());
            sample.Encode(_network.Written.back());
        }
        return _network.Result;
    }
    WriteResult WriteTo(const std::string &, const SampleEncoder &, std::int64_t) override
    {
        return WriteResult::Failed;
    }
    WriteResult Dispose(const SampleEncoder &, std::int64_t) override
    {
        ++_network.Disposals;
        return WriteResult::Ok;
    }
    int MatchedReaders() const override { return _network.Readable; }

private:
    Network &_network;
};

class Session final : public TransportSession
{
public:
    explicit Session(Network &network) : _network(network) {}
    std::unique_ptr<TransportWriter> CreateWriter(const TopicDescription &topic, const TopicQos &qos,
                                                  const std::vector<std::string> &) override
    {
        _network.Topic = topic;
        _network.WriterQos = qos;
        return std::make_unique<Writer>(_network);
    }
    std::unique_ptr<TransportReader> CreateReader(const TopicDescription &topic, const TopicQos &qos,
                                                  const std::vector<std::string> &,
                                                  SampleHandler handler) override
    {
        _network.Topic = topic;
        _network.Readers.push_back(qos);
        _network.Handler = std::move(handler);
        return std::make_unique<Reader>();
    }
    TransportCounters Counters() const override { return {}; }
    std::vector<RemoteEndpoint> RemoteEndpointsOn(const std::string &) const override
    {
        return _network.Endpoints;
    }
    std::vector<std::string> RemoteTopics() const override { return _network.Topics; }

private:
    Network &_network;
};

}  // namespace Rabit::Foreign
