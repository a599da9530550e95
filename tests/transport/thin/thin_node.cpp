// The endpoints of a fleet's node, without a gateway, for thin_test.py: all traffic on the air is the
// backend's own. Prints
//   matched after_s=S    all endpoints have matched those of all others
//   heard after_s=S      a beat of each other node came
// S counts from the start of the program. Runs until it is killed.
#include <rabit/transport/TransportFactory.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdint>
#include <iostream>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "../conformance/TestSample.h"

namespace
{

using namespace Rabit::Conformance;
using Clock = std::chrono::steady_clock;

constexpr auto BeatPeriod = std::chrono::milliseconds(500);
constexpr std::size_t BeatSize = 50;

struct Options
{
    Rabit::TransportSettings Settings;
    std::string Transport = "fastdds";
    int Others = 1;
    int LeaseMs = 30000;
    int PeriodMs = 10000;
};

std::int64_t Now()
{
    return std::chrono::nanoseconds(Clock::now().time_since_epoch()).count();
}

// The nodes that were heard. Thread-safe.
class Heard
{
public:
    void Add(std::string_view node)
    {
        const std::lock_guard lock(_mutex);
        _nodes.insert(std::string(node));
    }
    int Count() const
    {
        const std::lock_guard lock(_mutex);
        return static_cast<int>(_nodes.size());
    }

private:
    mutable std::mutex _mutex;
    std::set<std::string> _nodes;
};

class Node
{
public:
    explicit Node(const Options &options)
        : _others(options.Others),
          _session(Rabit::MakeTransport(options.Transport)->Open(options.Settings, {}))
    {
        for (const char *topic : {"rabit/Beat", "rabit/Link", "Pose"})
        {
            Add(topic, Telemetry());
        }
        Add("Status", State());
    }

    void Run()
    {
        const auto begin = Clock::now();
        bool matched = false;
        bool heard = false;
        for (auto next = begin;; next += BeatPeriod)
        {
            const auto after = [begin]
            { return std::chrono::duration<double>(Clock::now() - begin).count(); };
            if (!matched && IsMatched())
            {
                matched = true;
                std::cout << "matched after_s=" << after() << std::endl;
            }
            if (!heard && _heard.Count() == _others)
            {
                heard = true;
                std::cout << "heard after_s=" << after() << std::endl;
            }
            _writers.front()->Write(RawSample(std::vector<std::uint8_t>(BeatSize)), Now());
            std::this_thread::sleep_until(next + BeatPeriod);
        }
    }

private:
    // States too are read with best effort: gateways have a repair of their own.
    void Add(const std::string &topic, const Rabit::TopicQos &qos)
    {
        _writers.push_back(_session->CreateWriter(TextTopic(topic), qos, {}));
        _readers.push_back(_session->CreateReader(TextTopic(topic), Telemetry(), {},
                                                  [this](Rabit::SampleBytes, const Rabit::SampleInfo &info)
                                                  { Came(info); }));
    }
    void Came(const Rabit::SampleInfo &info) { _heard.Add(info.Node); }
    bool IsMatched() const
    {
        for (const auto &writer : _writers)
        {
            if (writer->MatchedReaders() < _others)
            {
                return false;
            }
        }
        for (const auto &reader : _readers)
        {
            if (reader->MatchedWriters() < _others)
            {
                return false;
            }
        }
        return true;
    }

    const int _others;
    Heard _heard;
    std::unique_ptr<Rabit::TransportSession> _session;
    std::vector<std::unique_ptr<Rabit::TransportWriter>> _writers;
    std::vector<std::unique_ptr<Rabit::TransportReader>> _readers;
};

}  // namespace

int main(int argc, char **argv)
{
    Options options;
    CLI::App app;
    app.add_option("--node", options.Settings.Node)->required();
    app.add_option("--others", options.Others);
    app.add_option("--transport", options.Transport);
    app.add_option("--lease", options.LeaseMs);
    app.add_option("--period", options.PeriodMs);
    CLI11_PARSE(app, argc, argv);
    options.Settings.Incarnation = 1;
    options.Settings.Lease = std::chrono::milliseconds(options.LeaseMs);
    options.Settings.AnnouncementPeriod = std::chrono::milliseconds(options.PeriodMs);
    try
    {
        Node(options).Run();
    }
    catch (const std::exception &error)
    {
        std::cerr << error.what() << "\n";
        return 1;
    }
}
