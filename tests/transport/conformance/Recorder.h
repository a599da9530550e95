// Handlers that remember what they were called with.
#pragma once

#include <rabit/transport/Transport.h>

#include <algorithm>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "TestSample.h"

namespace Rabit::Conformance
{

// A sample as it was handed over, copied.
struct Received
{
    std::vector<std::uint8_t> Bytes;
    std::string Text;
    WriterId Writer{};
    std::string Node;
    std::uint64_t Incarnation = 0;
    std::int64_t SourceTime = 0;
    std::uint64_t Sequence = 0;
    bool Alive = true;
    KeyHash Key{};
};

// Thread-safe. Must outlive the readers that call it.
class SampleRecorder
{
public:
    SampleHandler Handler()
    {
        return [this](SampleBytes bytes, const SampleInfo &info)
        {
            const std::lock_guard lock(_mutex);
            _received.push_back({{bytes.begin(), bytes.end()},
                                 TextOf(bytes),
                                 info.Writer,
                                 std::string(info.Node),
                                 info.Incarnation,
                                 info.SourceTime,
                                 info.Sequence,
                                 info.Alive,
                                 info.Key});
        };
    }
    std::vector<Received> All() const
    {
        const std::lock_guard lock(_mutex);
        return _received;
    }
    std::size_t Count() const
    {
        const std::lock_guard lock(_mutex);
        return _received.size();
    }
    std::vector<std::string> Texts() const
    {
        std::vector<std::string> texts;
        for (const auto &received : All())
        {
            texts.push_back(received.Text);
        }
        return texts;
    }

private:
    mutable std::mutex _mutex;
    std::vector<Received> _received;
};

// The log of a session. Thread-safe. Must outlive it.
class LineRecorder
{
public:
    std::function<void(const std::string &)> Sink()
    {
        return [this](const std::string &line)
        {
            const std::lock_guard lock(_mutex);
            _lines.push_back(line);
        };
    }
    // Whether there is a line with all those words.
    bool Has(const std::vector<std::string> &words) const
    {
        const std::lock_guard lock(_mutex);
        return std::any_of(_lines.begin(), _lines.end(),
                           [&](const std::string &line)
                           {
                               return std::all_of(words.begin(), words.end(),
                                                  [&](const std::string &word)
                                                  { return line.find(word) != std::string::npos; });
                           });
    }

private:
    mutable std::mutex _mutex;
    std::vector<std::string> _lines;
};

// Thread-safe. Must outlive the session that calls it.
class PeerRecorder
{
public:
    PeerHandler Handler()
    {
        return [this](const PeerEvent &event)
        {
            const std::lock_guard lock(_mutex);
            _events.push_back(event);
        };
    }
    int Count(PeerEvent::Kind what, const std::string &node, std::uint64_t incarnation) const
    {
        const std::lock_guard lock(_mutex);
        return static_cast<int>(std::count_if(_events.begin(), _events.end(),
                                              [&](const PeerEvent &event) {
                                                  return event.What == what && event.Node == node &&
                                                         event.Incarnation == incarnation;
                                              }));
    }
    std::size_t CountAll() const
    {
        const std::lock_guard lock(_mutex);
        return _events.size();
    }

private:
    mutable std::mutex _mutex;
    std::vector<PeerEvent> _events;
};

}  // namespace Rabit::Conformance
