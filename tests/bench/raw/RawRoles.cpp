#include "RawRoles.h"

#include "../common/MemberScore.h"
#include "../common/Scores.h"
#include "RawProgram.h"

#include <algorithm>
#include <chrono>
#include <iostream>
#include <mutex>
#include <stdexcept>
#include <thread>

namespace Rabit::Bench
{
namespace
{

using namespace std::chrono_literals;

// An answer that has not come by then never will. While the two programs look for each other they ask more
// often.
constexpr auto Patience = 1s;
constexpr auto PatienceAtFirst = 50ms;

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

// Writes for ever, for programs that join later.
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

// A member of a fleet whose members all write and read one topic, each at a fixed rate.
class Member final : public Program
{
public:
    explicit Member(const BenchOptions &options) : Program(options, "Member", "Member"), _score(options) {}

    int Run()
    {
        std::int64_t due = Now() + Options.Period;
        while (true)
        {
            if (Ready.Wait(std::chrono::nanoseconds(std::max<std::int64_t>(due - Now(), 0))))
            {
                TakeAll();
            }
            if (const std::int64_t now = Now(); now >= due)
            {
                WriteSurely({++_number | Options.Member << MemberShift, now, Padding});
                _score.Sent();
                due = std::max(due + Options.Period, now);
            }
            _score.ReportIfAsked();
        }
    }

private:
    // The upper half of a number is the member that wrote it.
    static constexpr int MemberShift = 32;

    void Handle(const RawSample &sample) override
    {
        const auto member = static_cast<std::size_t>(sample.Number >> MemberShift);
        // Some vendors deliver a program's own samples to it.
        if (member != Options.Member)
        {
            _score.Heard(member);
        }
    }

    MemberScore _score;
    std::uint64_t _number = 0;
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
    if (options.Role == "member")
    {
        return Member(options).Run();
    }
    throw std::invalid_argument("a plain program has no role " + options.Role);
}

}  // namespace Rabit::Bench
