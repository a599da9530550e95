#include "InputLines.h"

#include <condition_variable>
#include <deque>
#include <iostream>
#include <mutex>
#include <thread>
#include <utility>

namespace Rabit::Tool
{
namespace
{

// Lines kept; beyond, the reading thread waits until one is taken.
constexpr std::size_t MostLines = 1000;

}  // namespace

struct InputLines::State
{
    std::mutex Mutex;
    std::condition_variable Taken;
    std::deque<std::string> Lines;
    bool IsOver = false;
    std::function<void()> OnLine;

    // Returns false if the reading thread should end.
    bool Add(std::optional<std::string> line)
    {
        std::unique_lock lock(Mutex);
        Taken.wait(lock, [this] { return Lines.size() < MostLines || !OnLine; });
        if (!OnLine)
        {
            return false;
        }
        IsOver = !line;
        if (line)
        {
            Lines.push_back(std::move(*line));
        }
        OnLine();
        return !IsOver;
    }
};

InputLines::InputLines(std::function<void()> onLine) : _state(std::make_shared<State>())
{
    _state->OnLine = std::move(onLine);
    std::thread(
        [state = _state]
        {
            std::string line;
            while (std::getline(std::cin, line) && state->Add(line))
            {
            }
            state->Add(std::nullopt);
        })
        .detach();
}

InputLines::~InputLines()
{
    const std::lock_guard lock(_state->Mutex);
    _state->OnLine = nullptr;
    _state->Taken.notify_all();
}

bool InputLines::Take(Line &line)
{
    const std::lock_guard lock(_state->Mutex);
    if (_state->Lines.empty())
    {
        line.Text.reset();
        return _state->IsOver;
    }
    line.Text = std::move(_state->Lines.front());
    _state->Lines.pop_front();
    _state->Taken.notify_all();
    return true;
}

}  // namespace Rabit::Tool
