#pragma once

#include <rabit/transport/Transport.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "common/HeldDatagrams.h"

namespace Rabit
{

// The common part of all vendors' writers. Core: what a vendor's session shares with its writers and readers.
template <typename Core>
class VendorWriter : public TransportWriter
{
public:
    WriteResult Write(const SampleEncoder &sample, std::int64_t sourceTime) final
    {
        return Send(sample, sourceTime, false);
    }
    WriteResult WriteHeld(const SampleEncoder &sample, std::int64_t sourceTime) final
    {
        HeldDatagrams::Scope holding(_held);
        return Send(sample, sourceTime, false);
    }
    std::size_t HeldBytes() const final { return _held.NextBytes(); }
    void SendHeld() final { _held.SendNext(); }
    WriteResult WriteTo(const std::string &node, const SampleEncoder &sample, std::int64_t sourceTime) final
    {
        if (_qos.Reliability != Reliability::BestEffort || _topic.KeyOf)
        {
            return Fail("only best-effort writers of topics without a key write to one node");
        }
        return SendTo(node, sample, sourceTime);
    }
    WriteResult Dispose(const SampleEncoder &sample, std::int64_t sourceTime) final
    {
        return _topic.KeyOf ? Send(sample, sourceTime, true)
                            : Fail("it has no key, so nothing of it can be disposed");
    }

protected:
    static constexpr std::size_t HeaderSize = 4;

    VendorWriter(std::shared_ptr<Core> core, const TopicDescription &topic, const TopicQos &qos)
        : _core(std::move(core)), _topic(topic), _qos(qos)
    {
    }

    virtual WriteResult Send(const SampleEncoder &sample, std::int64_t sourceTime, bool dispose) = 0;
    virtual WriteResult SendTo(const std::string &node, const SampleEncoder &sample,
                               std::int64_t sourceTime) = 0;

    // Sends what is held from before. Returns a result only if a sample of that size cannot be written.
    std::optional<WriteResult> Refuse(std::size_t size)
    {
        if (_core->IsClosed())
        {
            return Fail("the session is closed");
        }
        _held.SendAll();
        if (size > LargestSample)
        {
            return Fail("the sample is larger than 64 MiB", WriteResult::TooLarge);
        }
        return size < HeaderSize ? std::optional(Fail("the encoded sample is shorter than its header"))
                                 : std::nullopt;
    }
    WriteResult Fail(const char *why, WriteResult result = WriteResult::Failed)
    {
        _core->Log()->WriteFailed(_topic.Name, why);
        return result;
    }
    WriteResult TimedOut()
    {
        _core->Log()->WriteTimedOut(_topic.Name);
        return WriteResult::TimedOut;
    }
    // Tells readers how many padding bytes RTPS will add (OMG DDS-XTypes 1.3, 7.6.3.1.2).
    static void MarkPadding(std::uint8_t *data, std::size_t size)
    {
        data[3] = static_cast<std::uint8_t>((data[3] & ~3u) | ((4 - size % 4) % 4));
    }

    const std::shared_ptr<Core> _core;
    const TopicDescription _topic;
    const TopicQos _qos;

private:
    HeldDatagrams _held;
};

}  // namespace Rabit
