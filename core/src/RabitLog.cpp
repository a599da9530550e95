#include <rabit/RabitLog.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <unistd.h>

#include "LineWriter.h"

namespace Rabit
{
namespace
{

// What stands before a line of each level, by the level's number.
using Prefixes = std::array<std::string, 4>;

std::shared_ptr<const Prefixes> PrefixesOf(const std::string &name)
{
    return std::make_shared<const Prefixes>(
        Prefixes{name + ": debug: ", name + ": info: ", name + ": warning: ", name + ": error: "});
}

struct LogState
{
    std::mutex Mutex;
    std::shared_ptr<const RabitLog::Sink> Sink;
    std::vector<std::weak_ptr<const RabitLog::Sink>> Listeners;
    std::atomic<RabitLogLevel> Level{RabitLogLevel::Warning};
    LineWriter Stderr{STDERR_FILENO};
    std::shared_ptr<const Prefixes> Before = PrefixesOf("rabit");
};

// Never destroyed: threads may log while the process ends.
LogState &State()
{
    static LogState *const state = new LogState();
    return *state;
}

// The listeners that still exist.
std::vector<std::shared_ptr<const RabitLog::Sink>> ListenersNow()
{
    LogState &state = State();
    std::vector<std::shared_ptr<const RabitLog::Sink>> listeners;
    const std::lock_guard<std::mutex> lock(state.Mutex);
    for (auto at = state.Listeners.begin(); at != state.Listeners.end();)
    {
        if (auto listener = at->lock())
        {
            listeners.push_back(std::move(listener));
            ++at;
        }
        else
        {
            at = state.Listeners.erase(at);
        }
    }
    return listeners;
}

// C0 and DEL.
bool IsControl(char c)
{
    return static_cast<unsigned char>(c) < ' ' || c == 0x7f;
}

std::string WithoutControls(std::string text)
{
    std::replace_if(text.begin(), text.end(), IsControl, '?');
    return text;
}

void TellListeners(RabitLogLevel level, const std::string &text) noexcept
{
    try
    {
        for (const auto &listener : ListenersNow())
        {
            (*listener)(level, text);
        }
    }
    catch (...)  // costs no line
    {
    }
}

}  // namespace

std::shared_ptr<void> RabitLog::Listen(Sink listener)
{
    auto shared = std::make_shared<Sink>(std::move(listener));
    LogState &state = State();
    const std::lock_guard<std::mutex> lock(state.Mutex);
    // Also here: a process that logs nothing would keep those that are gone.
    std::erase_if(state.Listeners, [](const auto &one) { return one.expired(); });
    state.Listeners.push_back(shared);
    return shared;
}

void RabitLog::SetSink(Sink sink)
{
    auto shared = sink ? std::make_shared<const Sink>(std::move(sink)) : nullptr;
    LogState &state = State();
    {
        const std::lock_guard<std::mutex> lock(state.Mutex);
        state.Sink.swap(shared);
    }
    // The former sink goes here, outside the lock.
}

void RabitLog::SetName(const std::string &name)
{
    try
    {
        auto prefixes = PrefixesOf(WithoutControls(name));
        LogState &state = State();
        const std::lock_guard<std::mutex> lock(state.Mutex);
        state.Before.swap(prefixes);
    }
    catch (...)  // out of memory: the former name stays
    {
    }
}

void RabitLog::SetLevel(RabitLogLevel level)
{
    State().Level.store(level);
}

RabitLogLevel RabitLog::GetLevel()
{
    return State().Level.load();
}

void RabitLog::Write(RabitLogLevel level, const std::string &text) noexcept
{
    LogState &state = State();
    if (level < state.Level.load() || level == RabitLogLevel::Off)
    {
        return;
    }
    if (std::any_of(text.begin(), text.end(), IsControl))
    {
        try
        {
            Write(level, WithoutControls(text));
        }
        catch (...)  // out of memory for the text
        {
        }
        return;
    }
    TellListeners(level, text);
    std::shared_ptr<const Sink> sink;
    std::shared_ptr<const Prefixes> before;
    try
    {
        {
            const std::lock_guard<std::mutex> lock(state.Mutex);
            sink = state.Sink;
            before = state.Before;
        }
        if (sink)
        {
            (*sink)(level, text);
            return;
        }
    }
    catch (...)  // a broken sink must not cost the line, nor end the process
    {
    }
    state.Stderr.Write(before ? std::string_view((*before)[static_cast<std::size_t>(level)]) : "", text);
}

void RabitLog::Print(const std::string &line) noexcept
{
    State().Stderr.Write("", line);
}

}  // namespace Rabit
