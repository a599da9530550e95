#pragma once

#include <cstdint>
#include <mutex>
#include <set>

namespace Rabit
{

// A number that no other living object of its kind has in this process. Any thread.
template <typename Kind>
class ProcessNumber
{
public:
    // Takes `wanted` if it is free; otherwise the first free number from `others` on.
    ProcessNumber(std::uint32_t wanted, std::uint32_t others) : _number(wanted)
    {
        Table &table = All();
        const std::lock_guard lock(table.Mutex);
        while (!table.Taken.insert(_number).second)
        {
            _number = others++;
        }
    }
    ~ProcessNumber()
    {
        Table &table = All();
        const std::lock_guard lock(table.Mutex);
        table.Taken.erase(_number);
    }
    ProcessNumber(const ProcessNumber &) = delete;
    ProcessNumber &operator=(const ProcessNumber &) = delete;
    std::uint32_t Get() const { return _number; }

private:
    struct Table
    {
        std::mutex Mutex;
        std::set<std::uint32_t> Taken;  // guarded by Mutex
    };
    static Table &All()
    {
        static Table table;
        return table;
    }

    std::uint32_t _number;
};

}  // namespace Rabit
