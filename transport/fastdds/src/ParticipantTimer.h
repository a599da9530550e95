#pragma once

#include <fastdds/rtps/participant/RTPSParticipant.h>
#include <fastdds/rtps/resources/TimedEvent.h>

#include <chrono>
#include <functional>
#include <memory>
#include <mutex>

namespace Rabit::FastDds
{

// Makes a call at a chosen time, on the thread on which the vendor announces its participant. Thread-safe.
class ParticipantTimer
{
public:
    using TimePoint = std::chrono::steady_clock::time_point;

    // At takes effect between Start and Stop. Call both before the participant is removed.
    void Start(const eprosima::fastrtps::rtps::RTPSParticipant &participant, std::function<void()> call);
    void Stop();

    // Sets the time of the call, in place of an earlier one. Does not block, so the vendor's locks may be
    // held.
    void At(TimePoint time);

private:
    std::mutex _mutex;
    std::unique_ptr<eprosima::fastrtps::rtps::TimedEvent> _event;  // guarded by _mutex
};

}  // namespace Rabit::FastDds
