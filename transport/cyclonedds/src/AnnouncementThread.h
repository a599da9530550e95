#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

#include "AnnouncementRounds.h"

namespace Rabit::Cyclone
{

// A thread that lives by AnnouncementRounds.
class AnnouncementThread
{
public:
    // Both are called on the thread, and may take the vendor's locks.
    struct Calls
    {
        std::function<bool()> IsUnheard;  // whether somebody has not shown that it knows us
        std::function<void()> Announce;
    };

    // answerGap, hasCard: AnnouncementRounds.
    AnnouncementThread(std::chrono::milliseconds answerGap, bool hasCard);
    ~AnnouncementThread();  // neither call is made afterwards
    AnnouncementThread(const AnnouncementThread &) = delete;
    AnnouncementThread &operator=(const AnnouncementThread &) = delete;

    // When the participant is there, once.
    void Start(Calls calls);
    // Somebody has come. Any thread; before Start too.
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
