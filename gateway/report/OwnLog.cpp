#include "report/OwnLog.h"

#include <rabit/RabitLog.h>
#include <rabit/base/UtcText.h>

#include <algorithm>
#include <chrono>
#include <deque>
#include <mutex>

#include "wire/NodeReports.h"

namespace Rabit
{
namespace
{

// Of the first line's number and the line end behind it.
constexpr std::size_t HeaderBytes = 16;
constexpr std::size_t LargestText = NodeReports::Largest - HeaderBytes;

const char *WordOf(RabitLogLevel level)
{
    switch (level)
    {
        case RabitLogLevel::Debug:
            return "debug";
        case RabitLogLevel::Info:
            return "info";
        case RabitLogLevel::Warning:
            return "warning";
        case RabitLogLevel::Error:
        case RabitLogLevel::Off:
            break;
    }
    return "error";
}

std::string TimeNow()
{
    const std::chrono::nanoseconds now = std::chrono::system_clock::now().time_since_epoch();
    return UtcText(static_cast<std::uint64_t>(now.count()));
}

}  // namespace

struct OwnLog::Lines
{
    mutable std::mutex Mutex;
    std::deque<std::string> Kept;  // guarded, as are the next two
    std::size_t Bytes = 0;
    std::uint32_t First = 0;  // number of the first kept line; wraps around

    void Add(RabitLogLevel level, const std::string &text)
    {
        std::string line = TimeNow() + ' ' + WordOf(level) + ' ' + text;
        if (line.size() > LongestLine)
        {
            line.resize(LongestLine - 3);
            line += "...";
        }
        line += '\n';
        const std::lock_guard lock(Mutex);
        Bytes += line.size();
        Kept.push_back(std::move(line));
        while (Kept.size() > MostLines || Bytes > MostBytes)
        {
            Bytes -= Kept.front().size();
            Kept.pop_front();
            ++First;
        }
    }

    // The lines from that place on, as many as fit.
    std::string TextFrom(std::size_t place) const
    {
        std::string text = std::to_string(First + static_cast<std::uint32_t>(place)) + '\n';
        const std::size_t most = text.size() + LargestText;
        for (; place < Kept.size() && text.size() + Kept[place].size() <= most; ++place)
        {
            text += Kept[place];
        }
        return text;
    }
};

OwnLog::OwnLog(const std::string &firstLine)
    : _lines(std::make_shared<Lines>()),
      _listener(RabitLog::Listen([lines = _lines](RabitLogLevel level, const std::string &text)
                                 { lines->Add(level, text); }))
{
    _lines->Add(RabitLogLevel::Info, firstLine);
}

std::string OwnLog::Last(std::uint32_t count) const
{
    const std::lock_guard lock(_lines->Mutex);
    const std::deque<std::string> &kept = _lines->Kept;
    std::size_t place = kept.size();
    std::size_t bytes = 0;
    while (place > 0 && kept.size() - place < count && bytes + kept[place - 1].size() <= LargestText)
    {
        bytes += kept[--place].size();
    }
    return _lines->TextFrom(place);
}

std::optional<std::string> OwnLog::From(std::uint32_t number) const
{
    const std::lock_guard lock(_lines->Mutex);
    const std::uint32_t place = number - _lines->First;  // modulo 2^32
    if (place == _lines->Kept.size())
    {
        return std::nullopt;
    }
    return _lines->TextFrom(place < _lines->Kept.size() ? place : 0);
}

}  // namespace Rabit
