#pragma once

#include <functional>
#include <mutex>
#include <utility>

namespace Rabit::FastDds
{

// A call that one object provides while it lives, and another one makes at any time. Thread-safe.
class DeferredCall
{
public:
    // An empty `call` ends it: when this returns, none is in progress and none will be made.
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
