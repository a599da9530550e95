#include "SimulatedSession.h"

#include <algorithm>
#include <utility>

#include "common/SettingsCheck.h"
#include "common/VendorWriter.h"

namespace Rabit::Simulated
{

namespace
{

// State that a session shares with its writers.
struct WriterCore
{
    const std::shared_ptr<SessionLog> &Log() const { return Participant->Log; }
    bool IsClosed() const { return false; }  // NetworkCore::Write tells

    std::shared_ptr<NetworkCore> Network;
    ParticipantPtr Participant;
};

class SimulatedWriter final : public VendorWriter<WriterCore>
{
public:
    SimulatedWriter(const std::shared_ptr<NetworkCore> &network, const ParticipantPtr &participant,
                    const TopicDescription &topic, const TopicQos &qos,
                    const std::vector<std::string> &partitions)
        : VendorWriter(std::make_shared<WriterCore>(WriterCore{network, participant}), topic, qos),
          _use(participant->Topics, topic),
          _state(network->AddWriter(participant, topic, qos, partitions))
    {
    }
    ~SimulatedWriter() override { _core->Network->RemoveWriter(*_core->Participant, *_state); }

    int MatchedReaders() const override { return _core->Network->MatchedReaders(*_state); }
    int Destinations() const override { return _core->Network->Destinations(*_core->Participant, *_state); }

private:
    WriteResult Send(const SampleEncoder &sample, std::int64_t sourceTime, bool dispose) override
    {
        return Send(sample, sourceTime, dispose, nullptr);
    }
    WriteResult SendTo(const std::string &node, const SampleEncoder &sample, std::int64_t sourceTime) override
    {
        return Send(sample, sourceTime, false, &node);
    }
    WriteResult Send(const SampleEncoder &encoder, std::int64_t sourceTime, bool dispose,
                     const std::string *node)
    {
        const std::size_t size = encoder.EncodedSize();
        if (const auto refused = Refuse(size))
        {
            return *refused;
        }
        const auto sample = std::make_shared<Sample>();
        sample->Bytes.resize(size);
        if (!encoder.Encode(sample->Bytes))
        {
            return Fail("the sample cannot be encoded");
        }
        if (_topic.KeyOf && !_topic.KeyOf(sample->Bytes, sample->Key))
        {
            return Fail("the encoded sample has no readable key");
        }
        const std::size_t datagram =
            _core->Participant->Settings.MaxDatagram - NetworkCore::MostOfSeal(*_core->Participant);
        sample->SourceTime = sourceTime;
        sample->Alive = !dispose;
        sample->Datagrams = static_cast<std::uint32_t>((size + datagram - 1) / datagram);
        if (dispose)
        {
            sample->Bytes.clear();
            sample->Datagrams = 1;
        }
        const bool isSent = HeldDatagrams::OfThisThread() != nullptr && sample->Datagrams > 1
                                ? SendInParts(sample, *HeldDatagrams::OfThisThread())
                                : _core->Network->Write(*_core->Participant, *_state, sample, node);
        return isSent ? WriteResult::Ok : Fail("the session is closed");
    }
    bool SendInParts(const std::shared_ptr<Sample> &sample, HeldDatagrams::Scope &held)
    {
        // At least 1: a datagram without a receiver would otherwise look as if none were held.
        const std::size_t bytes =
            std::max<std::size_t>(_core->Network->BytesOfPart(*_core->Participant, *_state, *sample), 1);
        const std::uint32_t last = sample->Datagrams - 1;
        bool isSent = true;
        for (std::uint32_t part = 0; part <= last && isSent; ++part)
        {
            const auto send = [core = _core, state = _state, sample, isLast = part == last, last]
            {
                return isLast ? core->Network->Write(*core->Participant, *state, sample, nullptr, last)
                              : core->Network->WritePart(*core->Participant, *state, *sample);
            };
            isSent = held.Keep(bytes, send) || send();
        }
        return isSent;
    }

    const TopicRegistry::Use _use;
    const WriterPtr _state;
};

class SimulatedReader final : public TransportReader
{
public:
    SimulatedReader(std::shared_ptr<NetworkCore> core, ParticipantPtr participant,
                    const TopicDescription &topic, const TopicQos &qos,
                    const std::vector<std::string> &partitions, SampleHandler handler)
        : _core(std::move(core)),
          _participant(std::move(participant)),
          _use(_participant->Topics, topic),
          _state(_core->AddReader(_participant, topic, qos, partitions, std::move(handler)))
    {
    }
    ~SimulatedReader() override
    {
        _core->RemoveReader(*_participant, *_state);
        _state->Gate.Close();
    }

    int MatchedWriters() const override { return _core->MatchedWriters(*_state); }

private:
    const std::shared_ptr<NetworkCore> _core;
    const ParticipantPtr _participant;
    const TopicRegistry::Use _use;
    const ReaderPtr _state;
};

}  // namespace

SimulatedSession::SimulatedSession(std::shared_ptr<NetworkCore> core, const TransportSettings &settings,
                                   PeerHandler onPeer)
    : _core(std::move(core)), _participant(_core->Join(settings, std::move(onPeer)))
{
    _participant->Turns.SetExchange(*this);
}

SimulatedSession::~SimulatedSession()
{
    _participant->Turns.RemoveExchange(*this);
    _core->Leave(*_participant);
    _participant->PeerGate.Close();
}

std::unique_ptr<TransportWriter> SimulatedSession::CreateWriter(const TopicDescription &topic,
                                                                const TopicQos &qos,
                                                                const std::vector<std::string> &partitions)
{
    CheckQos(topic, qos);
    return std::make_unique<SimulatedWriter>(_core, _participant, topic, qos, partitions);
}

std::unique_ptr<TransportReader> SimulatedSession::CreateReader(const TopicDescription &topic,
                                                                const TopicQos &qos,
                                                                const std::vector<std::string> &partitions,
                                                                SampleHandler handler)
{
    CheckQos(topic, qos);
    return std::make_unique<SimulatedReader>(_core, _participant, topic, qos, partitions, std::move(handler));
}

TransportCounters SimulatedSession::Counters() const
{
    return _participant->Log->Read();
}

}  // namespace Rabit::Simulated
