#pragma once

#include <rabit/transport/Transport.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "common/RejoiningEndpoint.h"
#include "common/RejoiningShared.h"
#include "common/SettingsCheck.h"
#include "common/TopicRegistry.h"

namespace Rabit
{

class RejoiningWriter final : public TransportWriter, private RejoiningEndpoint
{
public:
    RejoiningWriter(std::shared_ptr<RejoiningShared> shared, const TopicDescription &topic,
                    const TopicQos &qos, const std::vector<std::string> &partitions)
        : _shared(std::move(shared)),
          _topic(topic),
          _qos(qos),
          _partitions(partitions),
          _use(_shared->Topics, topic)
    {
        CheckQos(topic, qos);
        Enter(*_shared, *this);
    }
    ~RejoiningWriter() { Leave(*_shared, *this); }

    WriteResult Write(const SampleEncoder &sample, std::int64_t sourceTime) override
    {
        const UseGate::Use use(_shared->Gate);
        return use.Allowed() && _inner != nullptr ? _inner->Write(sample, sourceTime) : NotJoined();
    }
    WriteResult WriteHeld(const SampleEncoder &sample, std::int64_t sourceTime) override
    {
        const UseGate::Use use(_shared->Gate);
        return use.Allowed() && _inner != nullptr ? _inner->WriteHeld(sample, sourceTime) : NotJoined();
    }
    std::size_t HeldBytes() const override
    {
        const UseGate::Use use(_shared->Gate);
        return use.Allowed() && _inner != nullptr ? _inner->HeldBytes() : 0;
    }
    void SendHeld() override
    {
        const UseGate::Use use(_shared->Gate);
        if (use.Allowed() && _inner != nullptr)
        {
            _inner->SendHeld();
        }
    }
    WriteResult WriteTo(const std::string &node, const SampleEncoder &sample,
                        std::int64_t sourceTime) override
    {
        const UseGate::Use use(_shared->Gate);
        return use.Allowed() && _inner != nullptr ? _inner->WriteTo(node, sample, sourceTime) : NotJoined();
    }
    WriteResult Dispose(const SampleEncoder &sample, std::int64_t sourceTime) override
    {
        const UseGate::Use use(_shared->Gate);
        return use.Allowed() && _inner != nullptr ? _inner->Dispose(sample, sourceTime) : NotJoined();
    }
    int MatchedReaders() const override
    {
        const UseGate::Use use(_shared->Gate);
        return use.Allowed() && _inner != nullptr ? _inner->MatchedReaders() : 0;
    }

    int Destinations() const override
    {
        const UseGate::Use use(_shared->Gate);
        return use.Allowed() && _inner != nullptr ? _inner->Destinations() : 0;
    }

private:
    void Open(TransportSession &session) override
    {
        _inner = session.CreateWriter(_topic, _qos, _partitions);
    }
    void Close() override { _inner.reset(); }
    WriteResult NotJoined()
    {
        _shared->Log->WriteWithoutNetwork();
        return WriteResult::TimedOut;
    }

    const std::shared_ptr<RejoiningShared> _shared;
    const TopicDescription _topic;
    const TopicQos _qos;
    const std::vector<std::string> _partitions;
    const TopicRegistry::Use _use;
    std::unique_ptr<TransportWriter> _inner;  // used under the gate
};

}  // namespace Rabit
