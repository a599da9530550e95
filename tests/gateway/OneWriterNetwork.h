#pragma once

#include <rabit/transport/Transport.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

// A network for one writer. The test sets the result of each write.
namespace Rabit::OneWriter
{

struct Network
{
    WriteResult Result = WriteResult::Ok;
    int Writes = 0;
    WriteResult DisposalResult = WriteResult::Ok;
    int Disposals = 0;
    std::vector<std::int64_t> Times;
    int Readers = 0;
    std::size_t Parts = 1;  // datagrams of a sample
    std::size_t Held = 0;   // of them, those that wait
};

class Writer final : public TransportWriter
{
public:
    explicit Writer(Network &network) : _network(network) {}
    WriteResult Write(const SampleEncoder &sample, std::int64_t time) override
    {
        ++_network.Writes;
        _network.Times.push_back(time);
        std::vector<std::uint8_t> bytes(sample.EncodedSize());
        return sample.Encode(bytes) ? _network.Result : WriteResult::Failed;
    }
    WriteResult WriteHeld(const SampleEncoder &sample, std::int64_t time) override
    {
        const WriteResult result = Write(sample, time);
        _network.Held = result == WriteResult::Ok ? _network.Parts - 1 : 0;
        return result;
    }
    std::size_t HeldBytes() const override { return _network.Held > 0 ? 1400 : 0; }
    void SendHeld() override { _network.Held -= _network.Held > 0 ? 1 : 0; }
    WriteResult WriteTo(const std::string &, const SampleEncoder &, std::int64_t) override
    {
        return WriteResult::Failed;
    }
    WriteResult Dispose(const SampleEncoder &, std::int64_t) override
    {
        ++_network.Disposals;
        return _network.DisposalResult;
    }
    int MatchedReaders() const override { return _network.Readers; }

private:
    Network &_network;
};

class Session final : public TransportSession
{
public:
    explicit Session(Network &network) : _network(network) {}
    std::unique_ptr<TransportWriter> CreateWriter(const TopicDescription &, const TopicQos &,
                                                  const std::vector<std::string> &) override
    {
        return std::make_unique<Writer>(_network);
    }
    std::unique_ptr<TransportReader> CreateReader(const TopicDescription &, const TopicQos &,
                                                  const std::vector<std::string> &, SampleHandler) override
    {
        return nullptr;
    }
    TransportCounters Counters() const override { return {}; }

private:
    Network &_network;
};

}  // namespace Rabit::OneWriter
