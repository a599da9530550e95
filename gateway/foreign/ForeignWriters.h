#pragma once

#include <rabit/transport/Transport.h>

#include <chrono>
#include <cstdint>
#include <map>

namespace Rabit
{

// The writers of a topic from which samples came, and what their sequence numbers tell. Not thread-safe.
class ForeignWriters
{
public:
    using Duration = std::chrono::nanoseconds;

    // Number of writers kept. A new one replaces the one that was silent for longest.
    static constexpr std::size_t Most = 64;

    struct Writer
    {
        std::uint64_t Last = 0;  // number of its newest sample
        std::uint64_t Received = 0;
        std::uint64_t Missed = 0;
        Duration LastHeard{0};
    };

    // Counts a sample that arrived. False if the writer has sent one at least as new before: the sample was
    // overtaken on its way, or repeated.
    bool IsNew(const WriterId &id, std::uint64_t sequence, Duration now)
    {
        const auto found = _writers.find(id);
        if (found == _writers.end())
        {
            MakeRoom();
            _writers.emplace(id, Writer{sequence, 1, 0, now});
            return true;
        }
        Writer &writer = found->second;
        if (sequence <= writer.Last)
        {
            return false;
        }
        const std::uint64_t missed = sequence - writer.Last - 1;
        writer.Missed += missed;
        _missed += missed;
        writer.Last = sequence;
        ++writer.Received;
        writer.LastHeard = now;
        return true;
    }

    // Null if no sample of that writer came.
    const Writer *Find(const WriterId &id) const
    {
        const auto found = _writers.find(id);
        return found == _writers.end() ? nullptr : &found->second;
    }
    // Of all writers ever seen.
    std::uint64_t Missed() const { return _missed; }

private:
    void MakeRoom()
    {
        if (_writers.size() < Most)
        {
            return;
        }
        auto oldest = _writers.begin();
        for (auto it = _writers.begin(); it != _writers.end(); ++it)
        {
            oldest = it->second.LastHeard < oldest->second.LastHeard ? it : oldest;
        }
        _writers.erase(oldest);
    }

    std::map<WriterId, Writer> _writers;
    std::uint64_t _missed = 0;
};

}  // namespace Rabit
