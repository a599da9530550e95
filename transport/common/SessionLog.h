// Counts what goes wrong in a session, and logs it.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <string_view>

#include <rabit/transport/Transport.h>

namespace Rabit
{

// One per session, shared with its writers and readers. Thread-safe.
class SessionLog
{
public:
    explicit SessionLog(const TransportSettings &settings);

    // Each counts one event, and logs it if it is the 1st, 2nd, 4th, 8th ... of its kind.
    void HandlerThrew(const std::string &what, const char *error) noexcept;
    void WriteTimedOut(const std::string &topic) noexcept;
    // Counts a write that timed out because the network was not joined, without a line: the network's problem
    // is reported already.
    void WriteWithoutNetwork() noexcept { ++_writeTimeouts; }
    void WriteFailed(const std::string &topic, const char *why) noexcept;
    void IncompatibleQos(const std::string &topic) noexcept;
    // `node` is the other side's name; empty if it is unknown or no Rabit node.
    void InconsistentType(const std::string &topic, const std::string &ours, const std::string &theirs,
                          const std::string &node) noexcept;
    void MalformedSample(const std::string &topic, const char *why) noexcept;
    void MalformedDatagram() noexcept;
    void SamplesLost(std::uint64_t count) noexcept { _samplesLost += count; }

    // Count datagrams given to sockets; `bytes` are those of all these datagrams, without IP and UDP headers.
    void SentDiscovery(std::uint64_t datagrams, std::uint64_t bytes) noexcept
    {
        _discovery.Add(datagrams, bytes);
    }
    void SentSamples(std::uint64_t datagrams, std::uint64_t bytes) noexcept
    {
        _samples.Add(datagrams, bytes);
    }

    // Logs one line, without counting.
    void Line(const std::string &line) noexcept;

    // Bytes of the longest line: four names of 256 bytes, the longest that the guard admits, and a sentence.
    static constexpr std::size_t LongestLine = 2000;
    // Returns `text` as one line that is safe on a terminal: peers choose their names, so each byte outside
    // of printable ASCII becomes '?'. Text longer than LongestLine is cut. All lines of a log are so.
    static std::string Printable(std::string_view text);

    TransportCounters Read() const;

private:
    template <typename MakeLine>
    void Count(std::atomic<std::uint64_t> &counter, MakeLine &&makeLine) noexcept;

    struct Sent
    {
        void Add(std::uint64_t datagrams, std::uint64_t bytes) noexcept
        {
            constexpr std::uint64_t Headers = 20 + 8;  // IPv4, UDP
            Datagrams.fetch_add(datagrams, std::memory_order_relaxed);
            Bytes.fetch_add(bytes + Headers * datagrams, std::memory_order_relaxed);
        }
        std::atomic<std::uint64_t> Datagrams{0};
        std::atomic<std::uint64_t> Bytes{0};
    };

    const std::string _node;
    const std::function<void(const std::string &)> _sink;
    std::atomic<std::uint64_t> _writeTimeouts{0};
    std::atomic<std::uint64_t> _writeFailures{0};
    std::atomic<std::uint64_t> _handlerExceptions{0};
    std::atomic<std::uint64_t> _incompatibleQos{0};
    std::atomic<std::uint64_t> _samplesLost{0};
    std::atomic<std::uint64_t> _inconsistentTypes{0};
    std::atomic<std::uint64_t> _malformedSamples{0};
    std::atomic<std::uint64_t> _malformedDatagrams{0};
    Sent _discovery;
    Sent _samples;
};

}  // namespace Rabit
