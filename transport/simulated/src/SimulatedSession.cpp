#include "SimulatedSession.h"

#include <algorithm>
#include <mutex>
#include <utility>

#include "common/SettingsCheck.h"

namespace Rabit::Simulated
{

namespace
{

constexpr std::size_t MaxSample = LargestSample;
constexpr std::size_t HeaderSize = 4;

class SimulatedWriter final : public TransportWriter
{
public:
    SimulatedWriter(std::shared_ptr<NetworkCore> core, ParticipantPtr participant,
                    const TopicDescription &topic, const TopicQos &qos,
                    const std::vector<std::string> &partitions)
        : _core(std::move(core)),
          _participant(std::move(participant)),
          _topic(topic),
          _bestEffort(qos.Reliability == Reliability::BestEffort),
          _use(_participant->Topics, topic),
          _state(_core->AddWriter(_participant, topic, qos, partitions))
    {
    }
    ~SimulatedWriter() override { _core->RemoveWriter(*_participant, *_state); }

    WriteResult Write(const SampleEncoder &sample, std::int64_t sourceTime) override
    {
        return Send(sample, sourceTime, true);
    }

    WriteResult WriteHeld(const SampleEncoder &sample, std::int64_t sourceTime) override
    {
        return Send(sample, sourceTime, true, nullptr, true);
    }
    std::size_t HeldBytes() const override
    {
        const std::lock_guard lock(_mutex);
        // At least 1: a datagram without a receiver would otherwise look as if none were held.
        return _held == nullptr
                   ? 0
                   : std::max<std::size_t>(_core->BytesOfPart(*_participant, *_state, *_held), 1);
    }
    void SendHeld() override
    {
        const std::lock_guard lock(_mutex);
        if (_held != nullptr)
        {
            SendPart();
        }
    }

    WriteResult WriteTo(const std::string &node, const SampleEncoder &sample,
                        std::int64_t sourceTime) override
    {
        if (_bestEffort && !_topic.KeyOf)
        {
            return Send(sample, sourceTime, true, &node);
        }
        return Fail("only best-effort writers of topics without a key write to one node");
    }

    WriteResult Dispose(const SampleEncoder &sample, std::int64_t sourceTime) override
    {
        if (!_topic.KeyOf)
        {
            return Fail("it has no key, so nothing of it can be disposed");
        }
        return Send(sample, sourceTime, false);
    }

    int MatchedReaders() const override { return _core->MatchedReaders(*_state); }
    int Destinations() const override { return _core->Destinations(*_participant, *_state); }

private:
    WriteResult Fail(const char *why, WriteResult result = WriteResult::Failed)
    {
        _participant->Log->WriteFailed(_topic.Name, why);
        return result;
    }

    WriteResult Send(const SampleEncoder &encoder, std::int64_t sourceTime, bool alive,
                     const std::string *node = nullptr, bool hold = false)
    {
        const std::size_t size = encoder.EncodedSize();
        if (size > MaxSample)
        {
            return Fail("the sample is larger than 64 MiB", WriteResult::TooLarge);
        }
        if (size < HeaderSize)
        {
            return Fail("the encoded sample is shorter than its header");
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
        const std::size_t datagram = _participant->Settings.MaxDatagram;
        sample->SourceTime = sourceTime;
        sample->Alive = alive;
        sample->Datagrams = static_cast<std::uint32_t>((size + datagram - 1) / datagram);
        if (!alive)
        {
            sample->Bytes.clear();
            sample->Datagrams = 1;
        }
        const std::lock_guard lock(_mutex);
        while (_held != nullptr)
        {
            SendPart();
        }
        if (hold && sample->Datagrams > 1)
        {
            _held = sample;
            _partsSent = 0;
            return SendPart() ? WriteResult::Ok : Fail("the session is closed");
        }
        if (!_core->Write(*_participant, *_state, sample, node))
        {
            return Fail("the session is closed");
        }
        return WriteResult::Ok;
    }

    // Sends the next part of _held. Requires _mutex.
    bool SendPart()
    {
        if (_partsSent + 1 < _held->Datagrams)
        {
            const bool sent = _core->WritePart(*_participant, *_state, *_held);
            ++_partsSent;
            _held = sent ? _held : nullptr;
            return sent;
        }
        return _core->Write(*_participant, *_state, std::exchange(_held, nullptr), nullptr, _partsSent);
    }

    const std::shared_ptr<NetworkCore> _core;
    const ParticipantPtr _participant;
    const TopicDescription _topic;
    const bool _bestEffort;
    const TopicRegistry::Use _use;
    const WriterPtr _state;
    mutable std::mutex _mutex;  // guards the members below
    std::shared_ptr<Sample> _held;
    std::uint32_t _partsSent = 0;  // of _held
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
