// The cost of a recording: processor time of a process that records, of one that writes the same bytes
// plainly, and of one that only makes them. All take turns, and each makes the bytes at the same rate.
//   bench_recording [--folder F] [--seconds S] [--rounds N] [--rate MESSAGES] [--picture-rate PICTURES]
#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "recording/FolderDisk.h"
#include "recording/Recorder.h"

namespace
{

using Clock = std::chrono::steady_clock;
using Bytes = Rabit::Mcap::Bytes;

constexpr std::size_t MessageBytes = 100;
constexpr std::size_t PictureBytes = 1000000;

struct Options
{
    std::string Folder;
    double Seconds = 10;
    int Rounds = 3;
    double Rate = 10000;
    double PictureRate = 50;
};

double ProcessorSeconds()
{
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    const auto seconds = [](const timeval &time)
    { return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec); };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

std::uint64_t Now()
{
    return static_cast<std::uint64_t>(std::chrono::nanoseconds(Clock::now().time_since_epoch()).count());
}

// The destination of the bytes.
class Sink
{
public:
    virtual ~Sink() = default;
    virtual void Message(Bytes bytes) = 0;
    virtual void Picture(Bytes bytes) = 0;
    virtual std::uint64_t Lost() const { return 0; }
};

class NoSink final : public Sink
{
public:
    void Message(Bytes) override {}
    void Picture(Bytes) override {}
};

// A thread that takes the pending bytes ten times a second and writes them unchanged. It syncs them to the
// disk as often as the recorder does.
class PlainSink final : public Sink
{
public:
    explicit PlainSink(const std::string &folder)
        : _descriptor(::open((folder + "/plain").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644)),
          _thread([this] { Run(); })
    {
    }
    ~PlainSink() override
    {
        {
            const std::lock_guard lock(_mutex);
            _ends = true;
        }
        _changed.notify_one();
        _thread.join();
        ::close(_descriptor);
    }
    void Message(Bytes bytes) override
    {
        const std::lock_guard lock(_mutex);
        _bytes.insert(_bytes.end(), bytes.begin(), bytes.end());
    }
    void Picture(Bytes bytes) override
    {
        const std::lock_guard lock(_mutex);
        _pictures.push_back(std::move(bytes));
    }

private:
    void Run()
    {
        bool ends = false;
        for (int turn = 0; !ends; ++turn)
        {
            Bytes bytes;
            std::vector<Bytes> pictures;
            {
                std::unique_lock lock(_mutex);
                _changed.wait_for(lock, std::chrono::milliseconds(100), [this] { return _ends; });
                bytes.swap(_bytes);
                pictures.swap(_pictures);
                ends = _ends;
            }
            Write(bytes);
            for (const Bytes &picture : pictures)
            {
                Write(picture);
            }
            if (turn % 4 == 3)
            {
                static_cast<void>(::fdatasync(_descriptor));
            }
        }
    }
    void Write(const Bytes &bytes)
    {
        if (::write(_descriptor, bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size()))
        {
            std::perror("bench_recording: write");
            std::_Exit(1);
        }
    }

    const int _descriptor;
    std::mutex _mutex;
    std::condition_variable _changed;
    Bytes _bytes;
    std::vector<Bytes> _pictures;
    bool _ends = false;
    std::thread _thread;
};

Rabit::RecordingSettings SettingsOf(const std::string &folder)
{
    Rabit::RecordingSettings settings;
    settings.Name = "bench";
    settings.Record.Folder = folder;
    settings.Record.Free = 0;
    return settings;
}

class RecorderSink final : public Sink
{
public:
    explicit RecorderSink(const std::string &folder)
        : _recorder(std::make_unique<Rabit::FolderDisk>(folder), SettingsOf(folder), Now),
          _message(_recorder.Inbox().AddStream({.Topic = "uav1/Pose", .SchemaName = ""})),
          _picture(_recorder.Inbox().AddStream({.Topic = "uav1/Picture", .SchemaName = ""}))
    {
    }
    void Message(Bytes bytes) override { Put(_message, std::move(bytes)); }
    void Picture(Bytes bytes) override { Put(_picture, std::move(bytes)); }
    std::uint64_t Lost() const override { return _lost; }

private:
    void Put(std::uint32_t stream, Bytes bytes)
    {
        const std::uint64_t now = Now();
        _lost += _recorder.Inbox().Put({stream, 0, now, now, std::move(bytes)}) ? 0 : 1;
    }

    Rabit::Recorder _recorder;
    const std::uint32_t _message;
    const std::uint32_t _picture;
    std::uint64_t _lost = 0;
};

// Numbers like an aircraft's: some of the bytes change from one message to the next.
Bytes MakeMessage(std::uint64_t number)
{
    std::array<double, MessageBytes / sizeof(double)> values{};
    for (std::size_t at = 0; at < values.size(); ++at)
    {
        values[at] = 47.0 + std::sin(1e-3 * static_cast<double>(number) + static_cast<double>(at));
    }
    Bytes bytes(MessageBytes);
    std::memcpy(bytes.data(), values.data(), sizeof values);
    return bytes;
}

// Returns the share of one processor that `sink` takes.
double Measure(Sink &sink, const Options &options, const std::vector<Bytes> &pictures)
{
    const double before = ProcessorSeconds();
    const Clock::time_point start = Clock::now();
    std::uint64_t messages = 0;
    std::uint64_t shown = 0;
    for (double passed = 0; passed < options.Seconds;
         passed = std::chrono::duration<double>(Clock::now() - start).count())
    {
        for (; static_cast<double>(messages) < passed * options.Rate; ++messages)
        {
            sink.Message(MakeMessage(messages));
        }
        for (; static_cast<double>(shown) < passed * options.PictureRate; ++shown)
        {
            sink.Picture(pictures[shown % pictures.size()]);
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(5));  // the pace, not a wait for something
    }
    return (ProcessorSeconds() - before) / options.Seconds;
}

double Median(std::vector<double> values)
{
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

}  // namespace

int main(int argc, char **argv)
{
    CLI::App app("What a recording costs beside writing the same bytes plainly");
    Options options;
    app.add_option("--folder", options.Folder, "Where to write; a folder of its own is made there")
        ->required();
    app.add_option("--seconds", options.Seconds, "For how long each writes");
    app.add_option("--rounds", options.Rounds, "How often each has its turn")->check(CLI::Range(1, 100));
    app.add_option("--rate", options.Rate, "Messages of 100 B a second");
    app.add_option("--picture-rate", options.PictureRate, "Pictures of 1 MB a second");
    CLI11_PARSE(app, argc, argv);

    const std::filesystem::path folder =
        std::filesystem::path(options.Folder) / ("bench_recording_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder);
    std::mt19937 random(1U);
    std::vector<Bytes> pictures(8, Bytes(PictureBytes));
    for (Bytes &picture : pictures)
    {
        std::generate(picture.begin(), picture.end(),
                      [&random] { return static_cast<std::uint8_t>(random()); });
    }

    const std::vector<std::pair<std::string, std::function<std::unique_ptr<Sink>()>>> contestants = {
        {"made alone", [] { return std::make_unique<NoSink>(); }},
        {"written plainly", [&folder] { return std::make_unique<PlainSink>(folder); }},
        {"recorded", [&folder] { return std::make_unique<RecorderSink>(folder); }}};
    std::vector<std::vector<double>> shares(contestants.size());
    std::uint64_t lost = 0;
    for (int round = 0; round < options.Rounds; ++round)
    {
        for (std::size_t at = 0; at < contestants.size(); ++at)
        {
            const std::unique_ptr<Sink> sink = contestants[at].second();
            shares[at].push_back(Measure(*sink, options, pictures));
            lost += sink->Lost();
        }
        for (const auto &entry : std::filesystem::directory_iterator(folder))
        {
            std::filesystem::remove(entry.path());
        }
    }
    std::filesystem::remove_all(folder);

    const double made = Median(shares[0]);
    std::printf("%-16s %10s %22s\n", "", "processor", "less what makes them");
    for (std::size_t at = 0; at < contestants.size(); ++at)
    {
        const double share = Median(shares[at]);
        std::printf("%-16s %8.1f %% %20.1f %%\n", contestants[at].first.c_str(), 100 * share,
                    100 * (share - made));
    }
    std::printf("recorded / written plainly: %.2f; not kept: %llu\n",
                (Median(shares[2]) - made) / (Median(shares[1]) - made),
                static_cast<unsigned long long>(lost));
    return lost == 0 ? 0 : 1;
}
