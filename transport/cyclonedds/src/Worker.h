#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

namespace Rabit::Cyclone
{

// A thread that runs the given work in order. It finishes the rest before it ends.
class Worker
{
public:
    Worker() : _thread([this] { Run(); }) {}
    ~Worker()
    {
        {
            const std::lock_guard lock(_mutex);
            _stop = true;
        }
        _changed.notify_one();
        _thread.join();
    }
    Worker(const Worker &) = delete;
    Worker &operator=(const Worker &) = delete;

    void Post(std::function<void()> work)
    {
        {
            const std::lock_guard lock(_mutex);
            _work.push_back(std::move(work));
        }
        _changed.notify_one();
    }

private:
    void Run()
    {
        std::unique_lock lock(_mutex);
        while (true)
        {
            _changed.wait(lock, [this] { return _stop || !_work.empty(); });
            if (_work.empty())
            {
                return;
            }
            const auto work = std::move(_work.front());
            _work.pop_front();
            lock.unlock();
            work();
            lock.lock();
        }
    }

    std::mutex _mutex;
    std::condition_variable _changed;
    std::deque<std::function<void()>> _work;  // guarded by _mutex
    bool _stop = false;                       // guarded by _mutex
    std::thread _thread;
};

}  // namespace Rabit::Cyclone
