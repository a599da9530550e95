#include <rabit/RabitLog.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include <unistd.h>

#include "LineWriter.h"

namespace Rabit
{
namespace
{

struct LogState
{
    std::mutex Mutex;
    std::shared_ptr<const RabitLog::Sink> Sink;
    std::vector<std::weak_ptr<const RabitLog::Sink>> Listeners;
    std::atomic<RabitLogLevel> Level{RabitLogLevel::Warning};
    LineWriter Stderr{STDERR_FILENO};
};

// Never destroyed: threads may log while the process ends.
LogState &State()
{
    static LogState *const state = new LogState();
    return *state;
}

const char *PrefixOf(RabitLogLevel level)
{
    switch (level)
    {
        case RabitLogLevel::Debug:
            return "rabit: debug: ";
        case RabitLogLevel::Info:
            return "rabit: info: ";
        case RabitLogLevel::Warning:
            return "rabit: warning: ";
        default:
            return "rabit: error: ";
    }
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
    try
    {
        std::shared_ptr<const Sink> sink;
        {
            const std::lock_guard<std::mutex> lock(state.Mutex);
            sink = state.Sink;
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
    state.Stderr.Write(PrefixOf(level), text);
}

void RabitLog::Print(const std::string &line) noexcept
{
    State().Stderr.Write("", line);
}

}  // namespace Rabit
