#include "common/SessionLog.h"

#include <algorithm>

namespace Rabit
{

SessionLog::SessionLog(const TransportSettings &settings) : _node(settings.Node), _sink(settings.Log) {}

void SessionLog::Line(const std::string &line) noexcept
{
    if (!_sink)
    {
        return;
    }
    try
    {
        _sink(Printable("transport of " + _node + ": " + line));
    }
    catch (...)  // a sink that fails leaves nowhere to log; the counters still tell
    {
        return;
    }
}

std::string SessionLog::Printable(std::string_view text)
{
    constexpr std::string_view Cut = "... (cut)";
    std::string line(text.substr(0, LongestLine));
    std::replace_if(
        line.begin(), line.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
    if (text.size() > LongestLine)
    {
        line.replace(LongestLine - Cut.size(), Cut.size(), Cut);
    }
    return line;
}

// Logs only the 1st, 2nd, 4th, 8th ... event, so that a fault at full data rate does not flood the log.
template <typename MakeLine>
void SessionLog::Count(std::atomic<std::uint64_t> &counter, MakeLine &&makeLine) noexcept
{
    const std::uint64_t count = ++counter;
    if ((count & (count - 1)) != 0)
    {
        return;
    }
    try
    {
        const std::string times = count > 1 ? " (" + std::to_string(count) + " of this kind so far)" : "";
        Line(makeLine() + times);
    }
    catch (...)  // out of memory for the text
    {
        return;
    }
}

void SessionLog::HandlerThrew(const std::string &what, const char *error) noexcept
{
    Count(_handlerExceptions, [&] { return "the handler of " + what + " threw: " + error; });
}

void SessionLog::WriteTimedOut(const std::string &topic) noexcept
{
    Count(_writeTimeouts, [&] { return "a write to " + topic + " timed out"; });
}

void SessionLog::WriteFailed(const std::string &topic, const char *why) noexcept
{
    Count(_writeFailures, [&] { return "a write to " + topic + " failed: " + why; });
}

void SessionLog::IncompatibleQos(const std::string &topic) noexcept
{
    Count(_incompatibleQos, [&] { return "the other side of " + topic + " has an incompatible QoS"; });
}

void SessionLog::InconsistentType(const std::string &topic, const std::string &ours,
                                  const std::string &theirs, const std::string &node) noexcept
{
    Count(_inconsistentTypes,
          [&]
          {
              return "topic " + topic + " has type " + ours + " here, but " + theirs +
                     (node.empty() ? " elsewhere" : " at " + node);
          });
}

void SessionLog::MalformedSample(const std::string &topic, const char *why) noexcept
{
    Count(_malformedSamples, [&] { return "a sample of " + topic + " was dropped: " + why; });
}

void SessionLog::MalformedDatagram() noexcept
{
    Count(_malformedDatagrams,
          [] { return std::string("a datagram that is no sound RTPS message was dropped"); });
}

TransportCounters SessionLog::Read() const
{
    TransportCounters counters;
    counters.WriteTimeouts = _writeTimeouts;
    counters.WriteFailures = _writeFailures;
    counters.HandlerExceptions = _handlerExceptions;
    counters.IncompatibleQos = _incompatibleQos;
    counters.SamplesLost = _samplesLost;
    counters.InconsistentTypes = _inconsistentTypes;
    counters.MalformedSamples = _malformedSamples;
    counters.MalformedDatagrams = _malformedDatagrams;
    counters.DiscoveryDatagrams = _discovery.Datagrams;
    counters.DiscoveryBytes = _discovery.Bytes;
    counters.SampleDatagrams = _samples.Datagrams;
    counters.SampleBytes = _samples.Bytes;
    return counters;
}

}  // namespace Rabit
