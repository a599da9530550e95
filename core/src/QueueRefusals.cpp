#include "QueueRefusals.h"

#include <rabit/RabitLog.h>

#include <utility>

namespace Rabit
{
namespace
{

constexpr const char *OtherNames = "(further names)";

std::string Messages(std::uint64_t count)
{
    return std::to_string(count) + (count == 1 ? " more message" : " more messages");
}

std::string MoreFull(const std::string &name, std::uint64_t count)
{
    return "queue \"" + name + "\" was full and refused " + Messages(count);
}

std::string MoreUnknown(const std::string &name, std::uint64_t count)
{
    return "there is no queue \"" + name + "\": " + Messages(count) + " for it " +
           (count == 1 ? "was" : "were") + " refused";
}

}  // namespace

QueueRefusals::Entry &QueueRefusals::EntryOf(Entries &entries, std::string &name)
{
    if (entries.size() >= MaxNames && entries.count(name) == 0)
    {
        name = OtherNames;
    }
    return entries[name];
}

std::uint64_t QueueRefusals::Count(Entry &entry)
{
    const std::chrono::nanoseconds now = _clock->Monotonic();
    ++entry.NotLogged;
    if (entry.Count++ > 0 && now - entry.LoggedAt < LogPeriod)
    {
        _waiting.store(true, std::memory_order_relaxed);
        return 0;
    }
    entry.LoggedAt = now;
    return std::exchange(entry.NotLogged, 0);
}

template <typename FirstLine, typename Line>
void QueueRefusals::Note(Entries &entries, const std::string &name, FirstLine firstLine, Line line)
{
    std::string entryName = name;
    std::uint64_t count = 0;
    bool first = false;
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        Entry &entry = EntryOf(entries, entryName);
        first = entry.Count == 0;
        count = Count(entry);
    }
    if (count > 0)
    {
        RabitLog::Write(RabitLogLevel::Warning, first ? firstLine() : line(entryName, count));
    }
}

void QueueRefusals::NoteFull(const std::string &name, int capacity)
{
    Note(
        _full, name,
        [&]
        {
            return "queue \"" + name + "\" is full: it refused a message, as " + std::to_string(capacity) +
                   " wait in it";
        },
        MoreFull);
}

void QueueRefusals::NoteUnknown(const std::string &name)
{
    Note(
        _unknown, name, [&] { return "there is no queue \"" + name + "\": a message for it was refused"; },
        MoreUnknown);
}

template <typename Line>
void QueueRefusals::ReportDue(Entries &entries, Line line, std::vector<std::string> &lines)
{
    const std::chrono::nanoseconds now = _clock->Monotonic();
    for (auto &[name, entry] : entries)
    {
        if (entry.NotLogged > 0 && now - entry.LoggedAt >= LogPeriod)
        {
            entry.LoggedAt = now;
            lines.push_back(line(name, std::exchange(entry.NotLogged, 0)));
        }
        else if (entry.NotLogged > 0)
        {
            _waiting.store(true, std::memory_order_relaxed);
        }
    }
}

void QueueRefusals::Report()
{
    if (!_waiting.load(std::memory_order_relaxed))
    {
        return;
    }
    std::vector<std::string> lines;
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        _waiting.store(false, std::memory_order_relaxed);
        ReportDue(_full, MoreFull, lines);
        ReportDue(_unknown, MoreUnknown, lines);
    }
    for (const std::string &line : lines)
    {
        RabitLog::Write(RabitLogLevel::Warning, line);
    }
}

std::vector<UnknownQueueInfo> QueueRefusals::Unknown() const
{
    const std::lock_guard<std::mutex> lock(_mutex);
    std::vector<UnknownQueueInfo> list;
    for (const auto &[name, entry] : _unknown)
    {
        list.push_back(UnknownQueueInfo{name, entry.Count});
    }
    return list;
}

}  // namespace Rabit
