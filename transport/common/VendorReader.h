#pragma once

#include <rabit/transport/Transport.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <utility>

#include "common/HandlerGate.h"
#include "common/InstanceTable.h"
#include "common/PeerSessions.h"

namespace Rabit
{

// The common part of all vendors' readers: it delivers samples with the identity of their writers, and the
// ends of instances. Core: what a vendor's session shares with its writers and readers.
template <typename Core>
class VendorReader : public TransportReader
{
protected:
    static constexpr std::size_t HeaderSize = 4;

    VendorReader(std::shared_ptr<Core> core, const TopicDescription &topic, SampleHandler handler)
        : _core(std::move(core)),
          _topic(topic),
          _gate(_core->Log(), "the reader of " + topic.Name),
          _handler(std::move(handler))
    {
    }

    // The sample without the padding that RTPS added. A submessage's length is a multiple of 4, so a sample
    // of another length came in fragments, which carry its true length.
    static SampleBytes WithoutPadding(SampleBytes bytes)
    {
        const bool isPadded = bytes.size() > HeaderSize && bytes.size() % 4 == 0;
        return bytes.first(bytes.size() -
                           (isPadded ? std::min<std::size_t>(bytes[3] & 3u, bytes.size() - HeaderSize) : 0));
    }

    // The functions below run under the gate.
    SampleInfo InfoFor(const WriterId &writer)
    {
        if (_lastWriter != writer || _lastNode == nullptr)
        {
            _lastNode = _core->IdentityOf(writer);
            _lastWriter = writer;
        }
        SampleInfo info;
        info.Writer = writer;
        if (_lastNode != nullptr)
        {
            info.Node = _lastNode->Node;
            info.Incarnation = _lastNode->Incarnation;
        }
        return info;
    }
    // `info` is the last one that InfoFor returned, completed.
    void Deliver(SampleBytes bytes, const SampleInfo &info)
    {
        if (_lastNode != nullptr)
        {
            _lastNode->Hear();
        }
        if (_topic.KeyOf)
        {
            _instances.Alive(info.Key, info.Writer);
        }
        _handler(bytes, info);
    }
    // The writer has disposed the instance, or only unregistered it.
    void DeliverEnd(SampleInfo info, bool isDisposed)
    {
        if (!_topic.KeyOf)
        {
            return;  // a topic without a key has no instance that could end
        }
        if (isDisposed)
        {
            _instances.Disposed(info.Key);
        }
        else if (_instances.Unregistered(info.Key, info.Writer))
        {
            info.SourceTime = 0;
            info.Sequence = 0;
        }
        else
        {
            return;  // other writers still have it
        }
        _handler({}, info);
    }
    void DeliverEndsOf(const WriterId &writer)
    {
        for (const KeyHash &key : _instances.WriterGone(writer))
        {
            SampleInfo info = InfoFor(writer);
            info.Alive = false;
            info.Key = key;
            _handler({}, info);
        }
    }

    const std::shared_ptr<Core> _core;
    const TopicDescription _topic;
    HandlerGate _gate;

private:
    const SampleHandler _handler;
    InstanceTable _instances;                      // under the gate
    WriterId _lastWriter{};                        // under the gate
    std::shared_ptr<const PeerSession> _lastNode;  // of _lastWriter; under the gate
};

}  // namespace Rabit
