#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

#include "AnnouncementRounds.h"

namespace Rabit::Cyclone
{

// A thread that announces the participant when AnnouncementRounds says so.
class AnnouncementThread
{
public:
    // Both are called on the thread, and may take the vendor's locks.
    struct Calls
    {
        std::function<bool()> IsUnheard;  // true if a peer has not shown that it knows us
        std::function<void()> Announce;
    };

    // `answerGap`, `hasCard`: see AnnouncementRounds.
    AnnouncementThread(std::chrono::milliseconds answerGap, bool hasCard);
    ~AnnouncementThread();  // no call is made afterwards
    AnnouncementThread(const AnnouncementThread &) = delete;
    AnnouncementThread &operator=(const AnnouncementThread &) = delete;

    // To be called once, when the participant exists.
    void Start(Calls calls);
    // A peer has appeared. Any thread; also before Start.
    void OnPeer();

private:
    using Clock = std::chrono::steady_clock;

    void Run();

    std::mutex _mutex;
    std::condition_variable _changed;
    AnnouncementRounds _rounds;  // guarded by _mutex
    bool _stop = false;          // guarded by _mutex
    Calls _calls;
    std::thread _thread;
};

}  // namespace Rabit::Cyclone
