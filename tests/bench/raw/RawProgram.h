#pragma once

#include "../common/Usage.h"
#include "RawChannel.h"

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace Rabit::Bench
{

// Wakes the application's thread from the listener.
class Bell
{
public:
    void Ring()
    {
        {
            const std::lock_guard lock(_mutex);
            _rung = true;
        }
        _changed.notify_one();
    }
    // Waits for at most `limit`. Returns true if it was rung since the last call.
    bool Wait(std::chrono::nanoseconds limit)
    {
        std::unique_lock lock(_mutex);
        const bool rung = _changed.wait_for(lock, limit, [this] { return _rung; });
        _rung = false;
        return rung;
    }

private:
    std::mutex _mutex;
    std::condition_variable _changed;
    bool _rung = false;
};

// Writes the sample that it was given last, on a thread of its own.
class WriterThread
{
public:
    explicit WriterThread(std::function<void(const RawSample &)> write)
        : _write(std::move(write)), _thread([this] { Run(); })
    {
    }
    ~WriterThread()
    {
        {
            const std::lock_guard lock(_mutex);
            _ended = true;
        }
        _changed.notify_one();
        _thread.join();
    }

    void Give(const RawSample &sample)
    {
        {
            const std::lock_guard lock(_mutex);
            _sample = sample;
            _padding.assign(sample.Padding.begin(), sample.Padding.end());
            _given = true;
        }
        _changed.notify_one();
    }

private:
    void Run()
    {
        std::vector<std::uint8_t> padding;
        while (true)
        {
            RawSample sample;
            {
                std::unique_lock lock(_mutex);
                _changed.wait(lock, [this] { return _given || _ended; });
                if (_ended)
                {
                    return;
                }
                _given = false;
                sample = _sample;
                padding.swap(_padding);
            }
            sample.Padding = padding;
            _write(sample);
        }
    }

    const std::function<void(const RawSample &)> _write;
    std::mutex _mutex;
    std::condition_variable _changed;
    RawSample _sample;
    std::vector<std::uint8_t> _padding;
    bool _given = false;
    bool _ended = false;
    std::thread _thread;
};

// A program with one channel, whose samples are handled by the application's thread, or in the listener.
class Program
{
public:
    Program(const BenchOptions &options, const std::string &writes, const std::string &reads)
        : Options(options), Padding(options.Padding(), std::uint8_t{0x5a})
    {
        Channel = OpenRawChannel(options, writes, reads, [this] { OnData(); });
        if (options.WriterThread)
        {
            _writer =
                std::make_unique<WriterThread>([this](const RawSample &sample) { WriteSurely(sample); });
        }
        {
            const std::lock_guard lock(_opening);
            _open = true;
        }
        Ready.Ring();
    }
    virtual ~Program() = default;

    virtual void Handle(const RawSample &sample) = 0;

    void TakeAll()
    {
        Channel->Take([this](const RawSample &sample) { Handle(sample); });
    }

    void WriteSurely(const RawSample &sample)
    {
        const std::int64_t end = Now() + 30'000'000'000;
        while (!Channel->Write(sample))
        {
            if (Now() > end)
            {
                throw std::runtime_error("a sample was not taken within 30 s");
            }
        }
    }

    // Like WriteSurely, on the writer's thread if the program has one.
    void Send(const RawSample &sample)
    {
        if (_writer)
        {
            _writer->Give(sample);
        }
        else
        {
            WriteSurely(sample);
        }
    }

    void WaitUntilMatched()
    {
        while (!Channel->IsMatched())
        {
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
    }

    const BenchOptions Options;
    std::vector<std::uint8_t> Padding;
    Bell Ready;
    std::unique_ptr<RawChannel> Channel;

private:
    void OnData()
    {
        if (!Options.InListener)
        {
            Ready.Ring();
            return;
        }
        const std::lock_guard lock(_opening);
        if (_open)
        {
            TakeAll();
        }
    }

    std::mutex _opening;
    bool _open = false;
    std::unique_ptr<WriterThread> _writer;
};

}  // namespace Rabit::Bench
