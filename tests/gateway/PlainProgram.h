#pragma once

#include <rabit/simulated/SimulatedTransport.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace Rabit
{

// A program without a gateway, on the simulated network, that reads one topic.
class PlainProgram
{
public:
    PlainProgram(SimulatedNetwork &network, const std::string &topic, const std::string &type,
                 Reliability reliability = Reliability::Reliable)
    {
        TransportSettings settings;
        settings.Node = "program";  // each session there has a name
        settings.Incarnation = 1;
        _session = SimulatedTransport(network).Open(settings, [](const PeerEvent &) {});
        _reader = _session->CreateReader({topic, type, {}}, {.Reliability = reliability}, {""},
                                         [this](SampleBytes bytes, const SampleInfo &)
                                         { Samples.emplace_back(bytes.begin(), bytes.end()); });
    }

    std::vector<std::vector<std::uint8_t>> Samples;

private:
    std::unique_ptr<TransportSession> _session;
    std::unique_ptr<TransportReader> _reader;
};

}  // namespace Rabit
