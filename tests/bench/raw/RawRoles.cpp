#include "RawRoles.h"

#include "../common/Scores.h"
#include "RawChannel.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <iostream>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

namespace Rabit::Bench
{
namespace
{

using namespace std::chrono_literals;

// An answer that has not come by then never will. As long as the two look for each other they ask more often.
constexpr auto Patience = 1s;
constexpr auto PatienceAtFirst = 50ms;

// What the listener tells the application's thread.
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
    // Whether it was rung since the last call.
    bool Wait(std::chrono::milliseconds limit)
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

// Writes what it was given last on a thread of its own.
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

    // As WriteSurely, by the thread that is there for it if there is one.
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
            std::this_thread::sleep_for(1ms);
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

class Ping final : public Program
{
public:
    explicit Ping(const BenchOptions &options) : Program(options, "Ping", "Pong"), _score(options) {}

    int Run()
    {
        WaitUntilMatched();
        Ask(0);
        while (!IsComplete())
        {
            if (Ready.Wait(Limit()))
            {
                TakeAll();
            }
            else
            {
                GiveUpOld();
            }
        }
        return 0;
    }

private:
    void Handle(const RawSample &sample) override
    {
        const std::int64_t now = Now();
        const std::lock_guard lock(_mutex);
        if (sample.Number == _asked && !_score.IsComplete())
        {
            _score.Add(sample.Number, now - sample.SentAt);
            Next();
        }
    }

    void GiveUpOld()
    {
        const std::lock_guard lock(_mutex);
        if (_asked == 0)
        {
            Ask(0);
        }
        else if (!_score.IsComplete() && Now() - _askedAt > 1'000'000'000)
        {
            _score.Add(_asked, -1);
            Next();
        }
    }

    void Next()
    {
        if (!_score.IsComplete())
        {
            Ask(_asked + 1);
        }
        else
        {
            Ready.Ring();
        }
    }

    void Ask(std::uint64_t number)
    {
        _asked = number;
        _askedAt = Now();
        Program::Send({number, _askedAt, Padding});
    }

    bool IsComplete()
    {
        const std::lock_guard lock(_mutex);
        return _score.IsComplete();
    }

    std::chrono::milliseconds Limit()
    {
        const std::lock_guard lock(_mutex);
        return _asked == 0 ? PatienceAtFirst : std::chrono::milliseconds(Patience);
    }

    std::recursive_mutex _mutex;
    PingScore _score;
    std::uint64_t _asked = 0;
    std::int64_t _askedAt = 0;
};

class Pong final : public Program
{
public:
    explicit Pong(const BenchOptions &options) : Program(options, "Pong", "Ping"), _score(options) {}

    int Run()
    {
        while (true)
        {
            if (Ready.Wait(1000ms))
            {
                TakeAll();
            }
        }
    }

private:
    void Handle(const RawSample &sample) override
    {
        Send(sample);
        _score.Add(sample.Number);
    }

    ReceiverScore _score;
};

class Source final : public Program
{
public:
    explicit Source(const BenchOptions &options) : Program(options, "Ping", "Pong"), _score(options) {}

    int Run()
    {
        WaitUntilMatched();
        WriteSurely({0, Now(), Padding});
        std::this_thread::sleep_for(200ms);  // both sides' first exchange is not what is measured
        const std::int64_t begin = Now();
        for (std::uint64_t number = 1; number <= Options.Last(); ++number)
        {
            _score.Sending(number);
            WriteSurely({number, Now(), Padding});
            Pace(begin, number);
        }
        Channel->WaitForAcknowledgements();
        _score.Complete();
        return 0;
    }

private:
    void Handle(const RawSample &) override {}

    void Pace(std::int64_t begin, std::uint64_t number) const
    {
        const std::int64_t due = begin + static_cast<std::int64_t>(number) * Options.Period;
        if (Options.Period > 0)
        {
            std::this_thread::sleep_for(std::chrono::nanoseconds(std::max<std::int64_t>(due - Now(), 0)));
        }
    }

    SourceScore _score;
};

class Sink final : public Program
{
public:
    explicit Sink(const BenchOptions &options) : Program(options, "Pong", "Ping"), _score(options) {}

    int Run()
    {
        while (true)
        {
            if (Ready.Wait(1000ms))
            {
                TakeAll();
            }
        }
    }

private:
    void Handle(const RawSample &sample) override { _score.Add(sample.Number); }

    ReceiverScore _score;
};

// Writes for ever, for those who join later.
class Announce final : public Program
{
public:
    explicit Announce(const BenchOptions &options) : Program(options, "Pong", "Ping") {}

    int Run()
    {
        for (std::uint64_t number = 1;; ++number)
        {
            WriteSurely({number, Now(), Padding});
            std::this_thread::sleep_for(std::chrono::nanoseconds(Options.Period));
        }
    }

private:
    void Handle(const RawSample &) override {}
};

class Join final : public Program
{
public:
    explicit Join(const BenchOptions &options) : Program(options, "Ping", "Pong") {}

    int Run()
    {
        while (!_seen)
        {
            if (Ready.Wait(1000ms))
            {
                TakeAll();
            }
        }
        return 0;
    }

private:
    void Handle(const RawSample &) override
    {
        if (!_seen)
        {
            _seen = true;
            std::cout << "{\"first_message_ns\": " << Now() - Options.SpawnedAt << "}" << std::endl;
        }
    }

    bool _seen = false;
};

}  // namespace

int RunRawRole(const BenchOptions &options)
{
    if (options.Role == "ping")
    {
        return Ping(options).Run();
    }
    if (options.Role == "pong")
    {
        return Pong(options).Run();
    }
    if (options.Role == "source")
    {
        return Source(options).Run();
    }
    if (options.Role == "sink")
    {
        return Sink(options).Run();
    }
    if (options.Role == "announce")
    {
        return Announce(options).Run();
    }
    if (options.Role == "join")
    {
        return Join(options).Run();
    }
    throw std::invalid_argument("a plain program has no role " + options.Role);
}

}  // namespace Rabit::Bench
