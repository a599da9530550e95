// The writers and readers of a RejoiningSession: each stands in front of one of the backend's session.
#pragma once

#include <rabit/transport/Transport.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/RejoiningShared.h"
#include "common/SettingsCheck.h"
#include "common/TopicRegistry.h"

namespace Rabit
{

// Endpoint: TransportWriter or TransportReader.
template <typename Endpoint>
class Rejoining : public Endpoint, private RejoiningEndpoint
{
public:
    ~Rejoining() override { Leave(*_shared, *this); }

protected:
    using Make = std::function<std::unique_ptr<Endpoint>(BackendSession &)>;

    Rejoining(std::shared_ptr<RejoiningShared> shared, const TopicDescription &topic, const TopicQos &qos,
              Make make)
        : _shared(std::move(shared)), _make(std::move(make)), _use(*_shared->Topics, topic)
    {
        CheckQos(topic, qos);
        Enter(*_shared, *this);
    }

    // Returns call(endpoint of the backend); empty if the network is not joined.
    template <typename Call>
    auto Ask(const Call &call) const -> std::optional<decltype(call(std::declval<Endpoint &>()))>
    {
        const UseGate::Use use(_shared->Gate);
        return use.Allowed() && _inner != nullptr ? std::optional(call(*_inner)) : std::nullopt;
    }

    const std::shared_ptr<RejoiningShared> _shared;

private:
    void Open(BackendSession &session) final { _inner = _make(session); }
    void Close() final { _inner.reset(); }

    const Make _make;
    const TopicRegistry::Use _use;
    std::unique_ptr<Endpoint> _inner;  // used under the gate
};

class RejoiningReader final : public Rejoining<TransportReader>
{
public:
    RejoiningReader(std::shared_ptr<RejoiningShared> shared, const TopicDescription &topic,
                    const TopicQos &qos, const std::vector<std::string> &partitions,
                    const SampleHandler &handler)
        : Rejoining(std::move(shared), topic, qos,
                    [=](BackendSession &session)
                    { return session.CreateReader(topic, qos, partitions, handler); })
    {
    }

    int MatchedWriters() const override
    {
        return Ask([](auto &reader) { return reader.MatchedWriters(); }).value_or(0);
    }
};

class RejoiningWriter final : public Rejoining<TransportWriter>
{
public:
    RejoiningWriter(std::shared_ptr<RejoiningShared> shared, const TopicDescription &topic,
                    const TopicQos &qos, const std::vector<std::string> &partitions)
        : Rejoining(std::move(shared), topic, qos,
                    [=](BackendSession &session) { return session.CreateWriter(topic, qos, partitions); })
    {
    }

    WriteResult Write(const SampleEncoder &sample, std::int64_t sourceTime) override
    {
        return Try([&](auto &writer) { return writer.Write(sample, sourceTime); });
    }
    WriteResult WriteHeld(const SampleEncoder &sample, std::int64_t sourceTime) override
    {
        return Try([&](auto &writer) { return writer.WriteHeld(sample, sourceTime); });
    }
    std::size_t HeldBytes() const override
    {
        return Ask([](auto &writer) { return writer.HeldBytes(); }).value_or(0);
    }
    void SendHeld() override
    {
        Ask(
            [](auto &writer)
            {
                writer.SendHeld();
                return true;
            });
    }
    WriteResult WriteTo(const std::string &node, const SampleEncoder &sample,
                        std::int64_t sourceTime) override
    {
        return Try([&](auto &writer) { return writer.WriteTo(node, sample, sourceTime); });
    }
    WriteResult Dispose(const SampleEncoder &sample, std::int64_t sourceTime) override
    {
        return Try([&](auto &writer) { return writer.Dispose(sample, sourceTime); });
    }
    int MatchedReaders() const override
    {
        return Ask([](auto &writer) { return writer.MatchedReaders(); }).value_or(0);
    }
    int Destinations() const override
    {
        return Ask([](auto &writer) { return writer.Destinations(); }).value_or(0);
    }

private:
    template <typename Call>
    WriteResult Try(const Call &call)
    {
        const auto result = Ask(call);
        if (!result)
        {
            _shared->Log->WriteWithoutNetwork();
        }
        return result.value_or(WriteResult::TimedOut);
    }
};

}  // namespace Rabit
