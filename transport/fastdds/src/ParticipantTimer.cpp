#include "ParticipantTimer.h"

#include <algorithm>
#include <utility>

namespace Rabit::FastDds
{

using eprosima::fastrtps::rtps::TimedEvent;

void ParticipantTimer::Start(const eprosima::fastrtps::rtps::RTPSParticipant &participant,
                             std::function<void()> call)
{
    auto event = std::make_unique<TimedEvent>(
        participant.get_resource_event(),
        [call = std::move(call)]
        {
            call();
            return false;  // do not repeat
        },
        0);
    const std::lock_guard lock(_mutex);
    _event = std::move(event);
}

void ParticipantTimer::Stop()
{
    std::unique_ptr<TimedEvent> event;
    {
        const std::lock_guard lock(_mutex);
        event = std::move(_event);
    }
    // Its destructor waits for the vendor's thread, which may be in At.
}

void ParticipantTimer::At(TimePoint time)
{
    const std::chrono::duration<double, std::milli> left = time - TimePoint::clock::now();
    const std::lock_guard lock(_mutex);
    if (_event != nullptr)
    {
        _event->update_interval_millisec(std::max(left.count(), 0.0));
        _event->cancel_timer();
        _event->restart_timer();
    }
}

}  // namespace Rabit::FastDds
