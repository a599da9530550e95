#include <rabit/PublishSubscribeMessage.h>

#include "MessageTypes.h"

#include <rabit/RabitManagerTrace.h>
#include <rabit/RabitMessage.h>

#include <optional>
#include <stdexcept>
#include <utility>

namespace Rabit
{
namespace
{

std::uint64_t NextIdentity()
{
    static std::atomic<std::uint64_t> last{0};
    return last.fetch_add(1, std::memory_order_relaxed) + 1;
}

std::unique_ptr<RabitMessage> NotNull(std::unique_ptr<RabitMessage> message)
{
    if (!message)
    {
        throw std::invalid_argument("a global copy cannot be made of a null message");
    }
    return message;
}

}  // namespace

PublishSubscribeMessage::PublishSubscribeMessage(std::unique_ptr<RabitMessage> stMessage,
                                                 std::shared_ptr<const RabitClock> clock)
    : _identity(NextIdentity()),
      _clock(clock ? std::move(clock) : RabitClock::System()),
      _usesSystemClock(_clock == RabitClock::System()),
      _mutex(std::make_shared<std::mutex>()),
      _published(_mutex),
      _message(NotNull(std::move(stMessage))),
      _type(_message->GetTypeIndex())
{
    // The global copy must hold neither another global copy nor itself.
    _message->_globalPublishSubscribeMessageRef.reset();
}

PublishSubscribeMessage::~PublishSubscribeMessage() = default;

void PublishSubscribeMessage::Register_SomethingPublished(const boost::function<void()> &handler)
{
    ConnectSomethingPublished(handler);
}

RabitConnection PublishSubscribeMessage::ConnectSomethingPublished(RabitHandler handler)
{
    return _published.Connect(std::move(handler));
}

// The message holds the contents of that post now.
inline void PublishSubscribeMessage::Mark(RabitMessage &msg, const PostTime &time,
                                          std::uint64_t sequence) const
{
    msg._timeStamp = time.GpsTimeSeconds;
    msg._exactStamp = time.GpsTime;
    msg._postedAt = time.Monotonic;
    msg._seenSource = _identity;
    msg._seenSequence = sequence;
    msg._seenTimeStamp = time.GpsTimeSeconds;
}

inline void PublishSubscribeMessage::MarkAsCurrent(RabitMessage &msg) const
{
    Mark(msg, PostTime{_message->_timeStamp, _message->_postedAt, _message->_exactStamp}, Sequence());
}

std::unique_ptr<RabitMessage> PublishSubscribeMessage::GetCopyOfMessage()
{
    std::unique_lock<std::mutex> lock(*_mutex);
    std::unique_ptr<RabitMessage> copy = _message->Clone();
    if (copy)
    {
        copy->_globalPublishSubscribeMessageRef.reset();
        MarkAsCurrent(*copy);
        lock.unlock();
        if (RabitManagerTrace::Current() != nullptr)
        {
            TellFetched(*copy);
        }
    }
    return copy;
}

// The usual clock is called directly, not through its interface.
inline PostTime PublishSubscribeMessage::Now() const
{
    static SystemTimeClock *const systemClock = SystemTimeClock::GetSystemTimeClock();
    return _usesSystemClock ? systemClock->Now() : _clock->Now();
}

void PublishSubscribeMessage::PostMessage(RabitMessage *msg)
{
    if (msg == nullptr)
    {
        throw std::invalid_argument("a null message cannot be posted");
    }
    if (RabitManagerTrace::Current() != nullptr)
    {
        PostTraced(*msg, nullptr);
        return;
    }
    PostTime now = Now();
    if (_usesSystemClock)
    {
        SystemTimeClock::GetSystemTimeClock()->ReportSteps();
    }
    Post(*msg, now, true);
}

void PublishSubscribeMessage::PostMessage(RabitMessage *msg, const PostTime &time)
{
    if (msg == nullptr)
    {
        throw std::invalid_argument("a null message cannot be posted");
    }
    if (RabitManagerTrace::Current() != nullptr)
    {
        PostTraced(*msg, &time);
        return;
    }
    PostTime given = time;
    Post(*msg, given, false);
}

// A post by a traced manager. The handlers of the post are not traced.
void PublishSubscribeMessage::PostTraced(RabitMessage &msg, const PostTime *time)
{
    const RabitManagerTrace::Pause trace;
    std::optional<PostTime> known = time != nullptr ? std::optional(*time) : trace->Posting(*this);
    if (known)
    {
        Post(msg, *known, false);
    }
    else
    {
        PostTime now = Now();
        if (_usesSystemClock)
        {
            SystemTimeClock::GetSystemTimeClock()->ReportSteps();
        }
        Post(msg, now, true);
    }
    trace->Posted(*this, msg, msg._seenSequence);
}

void PublishSubscribeMessage::TellFetched(const RabitMessage &msg) const
{
    const RabitManagerTrace::Pause trace;
    trace->Fetched(*this, msg, msg._seenSequence);
}

inline void PublishSubscribeMessage::CopyFromMessage(RabitMessage &msg)
{
    if (!_message->CopyMessage(&msg) && IsRefusal(*_message, msg))
    {
        throw std::invalid_argument("a message was posted under a name that holds another type");
    }
    // An override may have used CopyBase: the global copy must not own itself.
    if (_message->_globalPublishSubscribeMessageRef)
    {
        _message->_globalPublishSubscribeMessageRef.reset();
    }
}

// Makes the time stamp of a post later than that of the last one, unless the wall clock was set back. If
// the stamp would be too far ahead of the clock, releases the lock and reads the clock again.
void PublishSubscribeMessage::PutAfterLast(PostTime &time, std::unique_lock<std::mutex> &lock)
{
    if (!_usesSystemClock)
    {
        time.GpsTime = RabitClock::ToNanoseconds(time.GpsTimeSeconds);
    }
    const PostTime *latest = &time;
    std::chrono::nanoseconds stamp = time.GpsTime;
    while (time.GpsTime <= _lastStamp)
    {
        // A post of another thread may have overtaken this one: then this time is old, but the clock was
        // not set back.
        const bool overtaken = time.Monotonic < _lastReading.Monotonic;
        if (!overtaken && time.GpsTime < _lastReading.GpsTime - SystemTimeClock::LeastStepBack)
        {
            break;
        }
        stamp = _lastStamp + std::chrono::nanoseconds(1);
        if (!_usesSystemClock || stamp <= time.GpsTime + SystemTimeClock::MaxAhead)
        {
            latest = overtaken ? &_lastReading : &time;
            break;
        }
        lock.unlock();
        time = Now();
        lock.lock();
        stamp = time.GpsTime;
    }
    _lastReading = *latest;
    _lastStamp = stamp;
    if (stamp != time.GpsTime)
    {
        time.GpsTime = stamp;
        time.GpsTimeSeconds = RabitClock::ToSeconds(stamp);
    }
}

// The global copy holds the contents of a post. Requires the lock.
inline RabitEvent::Handlers PublishSubscribeMessage::Publish(const PostTime &time)
{
    _message->_timeStamp = time.GpsTimeSeconds;
    _message->_exactStamp = time.GpsTime;
    _message->_postedAt = time.Monotonic;
    _sequence.store(_sequence.load(std::memory_order_relaxed) + 1, std::memory_order_release);
    return _published.Snapshot();
}

void PublishSubscribeMessage::Post(RabitMessage &msg, PostTime &time, bool byOwnClock)
{
    RabitEvent::Handlers handlers;
    {
        std::unique_lock<std::mutex> lock(*_mutex);
        if (byOwnClock)
        {
            PutAfterLast(time, lock);
        }
        const double formerStamp = std::exchange(msg._timeStamp, time.GpsTimeSeconds);
        if (&msg != _message.get())
        {
            try
            {
                CopyFromMessage(msg);
            }
            catch (...)
            {
                msg._timeStamp = formerStamp;
                _message->_globalPublishSubscribeMessageRef.reset();
                throw;
            }
        }
        handlers = Publish(time);
        Mark(msg, time, Sequence());
    }
    handlers.Call();
}

void PublishSubscribeMessage::PostContents(std::unique_ptr<RabitMessage> &message, const PostTime &time)
{
    std::unique_lock<std::mutex> lock(*_mutex);
    const bool isExposed = (_sequence.load(std::memory_order_relaxed) & Exposed) != 0;
    if (!message || message->GetTypeIndex() != _type || isExposed || RabitManagerTrace::Current() != nullptr)
    {
        lock.unlock();
        PostMessage(message.get(), time);
        return;
    }
    std::swap(message, _message);
    std::swap(message->_globalPublishSubscribeMessageRef, _message->_globalPublishSubscribeMessageRef);
    const RabitEvent::Handlers handlers = Publish(time);
    lock.unlock();
    handlers.Call();
}

bool PublishSubscribeMessage::CopyToMessage(RabitMessage &msg)
{
    if (&msg != _message.get())
    {
        if (!msg.CopyMessage(_message.get()) && IsRefusal(msg, *_message))
        {
            return false;
        }
    }
    MarkAsCurrent(msg);
    return true;
}

bool PublishSubscribeMessage::FetchIfChanged(RabitMessage *msg)
{
    if (msg == nullptr)
    {
        throw std::invalid_argument("cannot fetch to a null message");
    }
    std::unique_lock<std::mutex> lock(*_mutex);
    const bool samePost = msg->_seenSource == _identity && msg->_seenSequence == Sequence();
    // If nothing was posted yet, a copy that was never registered differs only by its time stamp.
    const bool neverPosted = Sequence() == 0 && msg->_seenSource == 0;
    if ((samePost || neverPosted) && msg->CompareTime(_message.get()))
    {
        MarkAsCurrent(*msg);
        return false;
    }
    const bool copied = CopyToMessage(*msg);
    lock.unlock();
    if (copied && RabitManagerTrace::Current() != nullptr)
    {
        TellFetched(*msg);
    }
    return copied;
}

void PublishSubscribeMessage::ForceFetchMessage(RabitMessage *msg)
{
    ForceFetch(msg);
}

bool PublishSubscribeMessage::ForceFetch(RabitMessage *msg)
{
    if (msg == nullptr)
    {
        throw std::invalid_argument("cannot fetch to a null message");
    }
    std::unique_lock<std::mutex> lock(*_mutex);
    const bool copied = CopyToMessage(*msg);
    lock.unlock();
    if (copied && RabitManagerTrace::Current() != nullptr)
    {
        TellFetched(*msg);
    }
    return copied;
}

// Attaches the message that the global copy was just cloned from. It is current unless there was a post in
// between.
void PublishSubscribeMessage::AttachAsCurrent(RabitMessage &msg)
{
    const std::lock_guard<std::mutex> lock(*_mutex);
    msg._seenSource = RabitMessage::NothingSeenYet;
    if (Sequence() == 0)
    {
        MarkAsCurrent(msg);
    }
}

const std::unique_ptr<RabitMessage> &PublishSubscribeMessage::GetTestMessage()
{
    const std::lock_guard<std::mutex> lock(*_mutex);
    _sequence.fetch_or(Exposed, std::memory_order_release);
    return _message;
}

}  // namespace Rabit
