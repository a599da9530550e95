#pragma once

#include <rabit/simulated/SimulatedTransport.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "BeatSamples.h"
#include "MessageSample.h"
#include "names/NodeTag.h"

namespace Rabit
{

// A node of the simulated network whose beats the test writes. It has only a writer, unless a handler for
// the others' beats is given.
class HandNode
{
public:
    HandNode(SimulatedNetwork &network, const std::string &node, std::uint64_t incarnation,
             SampleHandler onBeat = {})
        : _network(network), _tag(NodeTagOf(node, incarnation))
    {
        TransportSettings settings;
        settings.Node = node;
        settings.Incarnation = incarnation;
        _session = SimulatedTransport(network).Open(settings, [](const PeerEvent &) {});
        TopicQos qos;
        qos.Reliability = Reliability::BestEffort;
        _writer = _session->CreateWriter({"rabit/Beat", "Rabit::Gateway::Beat", {}}, qos, {});
        if (onBeat)
        {
            _reader = _session->CreateReader({"rabit/Beat", "Rabit::Gateway::Beat", {}}, qos, {},
                                             std::move(onBeat));
        }
    }

    TransportSession &Session() { return *_session; }
    std::uint32_t Tag() const { return _tag; }
    // True if the other nodes hear what this one writes.
    bool IsHeard() const { return _writer->MatchedReaders() > 0; }
    // Returns a beat of this moment, to be changed and written.
    Gateway::Beat Beat() const { return BeatAt(_network.Now() + std::chrono::seconds(1)); }
    void Write(const Gateway::Beat &beat) { Write(static_cast<const RabitMessage &>(beat)); }
    void Write(const RabitMessage &message)
    {
        EXPECT_EQ(_writer->Write(MessageSample(message), _network.Now().count()), WriteResult::Ok);
    }
    void WriteBytes(const std::vector<std::uint8_t> &bytes)
    {
        EXPECT_EQ(_writer->Write(Bytes(bytes), _network.Now().count()), WriteResult::Ok);
    }

    struct Bytes final : SampleEncoder
    {
        explicit Bytes(const std::vector<std::uint8_t> &data) : Data(data) {}
        std::size_t EncodedSize() const override { return Data.size(); }
        bool Encode(std::span<std::uint8_t> buffer) const override
        {
            std::copy(Data.begin(), Data.end(), buffer.begin());
            return true;
        }
        const std::vector<std::uint8_t> &Data;
    };

private:
    SimulatedNetwork &_network;
    const std::uint32_t _tag;
    std::unique_ptr<TransportSession> _session;
    std::unique_ptr<TransportWriter> _writer;
    std::unique_ptr<TransportReader> _reader;
};

}  // namespace Rabit
