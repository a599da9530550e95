#pragma once

#include <functional>
#include <mutex>
#include <utility>

namespace Rabit::FastDds
{

// A call that one object provides as long as it lives, and another one makes whenever it likes. Thread-safe.
class DeferredCall
{
public:
    // Nothing: from now on none is made, and none is under way.
    void Set(std::function<void()> call)
    {
        const std::lock_guard lock(_mutex);
        _call = std::move(call);
    }
    void Run()
    {
        const std::lock_guard lock(_mutex);
        if (_call)
        {
            _call();
        }
    }

private:
    std::mutex _mutex;
    std::function<void()> _call;  // guarded by _mutex, also while it runs
};

}  // namespace Rabit::FastDds
