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

class RejoiningReader final : public TransportReader, private RejoiningEndpoint
{
public:
    RejoiningReader(std::shared_ptr<RejoiningShared> shared, const TopicDescription &topic,
                    const TopicQos &qos, const std::vector<std::string> &partitions, SampleHandler handler)
        : _shared(std::move(shared)),
          _topic(topic),
          _qos(qos),
          _partitions(partitions),
          _handler(std::move(handler)),
          _use(_shared->Topics, topic)
    {
        CheckQos(topic, qos);
        Enter(*_shared, *this);
    }
    ~RejoiningReader() { Leave(*_shared, *this); }

    int MatchedWriters() const override
    {
        const UseGate::Use use(_shared->Gate);
        return use.Allowed() && _inner != nullptr ? _inner->MatchedWriters() : 0;
    }

private:
    void Open(TransportSession &session) override
    {
        _inner = session.CreateReader(_topic, _qos, _partitions, _handler);
    }
    void Close() override { _inner.reset(); }

    const std::shared_ptr<RejoiningShared> _shared;
    const TopicDescription _topic;
    const TopicQos _qos;
    const std::vector<std::string> _partitions;
    const SampleHandler _handler;
    const TopicRegistry::Use _use;
    std::unique_ptr<TransportReader> _inner;  // used under the gate
};

}  // namespace Rabit
