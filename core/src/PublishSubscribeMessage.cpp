#include <rabit/PublishSubscribeMessage.h>

#include <rabit/RabitMessage.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <typeinfo>
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

// Takes something away for the duration of a scope and puts it back, whatever happens to it in between.
template <typename T>
class Keeper
{
public:
    explicit Keeper(T &kept) : _kept(kept), _value(std::move(kept)) {}
    ~Keeper() { _kept = std::move(_value); }
    Keeper(const Keeper &) = delete;
    Keeper &operator=(const Keeper &) = delete;

private:
    T &_kept;
    T _value;
};

}  // namespace

PublishSubscribeMessage::PublishSubscribeMessage(std::unique_ptr<RabitMessage> stMessage,
                                                 std::shared_ptr<const RabitClock> clock)
    : _identity(NextIdentity()),
      _clock(clock ? std::move(clock) : RabitClock::System()),
      _mutex(std::make_shared<std::mutex>()),
      _published(_mutex),
      _message(NotNull(std::move(stMessage))),
      _type(typeid(*_message)),
      _lastOwnStamp(-std::numeric_limits<double>::infinity())
{
    // The copy must not hold on to another global copy, nor to itself.
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

void PublishSubscribeMessage::MarkAsCurrent(RabitMessage &msg) const
{
    msg._timeStamp = _message->_timeStamp;
    msg._postedAt = _message->_postedAt;
    msg._seenSource = _identity;
    msg._seenSequence = Sequence();
    msg._seenTimeStamp = _message->_timeStamp;
}

std::unique_ptr<RabitMessage> PublishSubscribeMessage::GetCopyOfMessage()
{
    const std::lock_guard<std::mutex> lock(*_mutex);
    std::unique_ptr<RabitMessage> copy = _message->Clone();
    if (copy)
    {
        copy->_globalPublishSubscribeMessageRef.reset();
        MarkAsCurrent(*copy);
    }
    return copy;
}

void PublishSubscribeMessage::PostMessage(RabitMessage *msg)
{
    if (msg == nullptr)
    {
        throw std::invalid_argument("a null message cannot be posted");
    }
    Post(*msg, _clock->Now(), true);
}

void PublishSubscribeMessage::PostMessage(RabitMessage *msg, const PostTime &time)
{
    if (msg == nullptr)
    {
        throw std::invalid_argument("a null message cannot be posted");
    }
    Post(*msg, time, false);
}

void PublishSubscribeMessage::Post(RabitMessage &msg, const PostTime &time, bool strictlyIncreasing)
{
    RabitEvent::Handlers handlers;
    {
        const std::lock_guard<std::mutex> lock(*_mutex);
        double stamp = time.GpsTimeSeconds;
        if (strictlyIncreasing && stamp <= _lastOwnStamp)
        {
            stamp = std::nextafter(_lastOwnStamp, std::numeric_limits<double>::infinity());
        }
        const double formerStamp = std::exchange(msg._timeStamp, stamp);
        try
        {
            CopyFromMessage(msg);
        }
        catch (...)
        {
            msg._timeStamp = formerStamp;
            throw;
        }
        _message->_timeStamp = stamp;
        _message->_postedAt = time.Monotonic;
        if (strictlyIncreasing)
        {
            _lastOwnStamp = stamp;
        }
        const std::uint64_t sequence = _sequence.load(std::memory_order_relaxed) + 1;
        _sequence.store(sequence, std::memory_order_release);
        MarkAsCurrent(msg);
        handlers = _published.Snapshot();
    }
    handlers.Call();
}

void PublishSubscribeMessage::CopyFromMessage(RabitMessage &msg)
{
    if (&msg == _message.get())
    {
        return;
    }
    const Keeper<std::shared_ptr<PublishSubscribeMessage>> keepRef(
        _message->_globalPublishSubscribeMessageRef);
    // Overrides of one type that return false all the same are taken to have copied.
    if (!_message->CopyMessage(&msg) && typeid(msg) != _type)
    {
        throw std::invalid_argument("a message was posted under a name that holds another type");
    }
}

bool PublishSubscribeMessage::CopyToMessage(RabitMessage &msg)
{
    if (&msg != _message.get())
    {
        const Keeper<std::shared_ptr<PublishSubscribeMessage>> keepRef(msg._globalPublishSubscribeMessageRef);
        if (!msg.CopyMessage(_message.get()) && typeid(msg) != _type)
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
    const std::lock_guard<std::mutex> lock(*_mutex);
    const bool stampsEqual = msg->_timeStamp == _message->_timeStamp;
    const bool samePost = msg->_seenSource == _identity && msg->_seenSequence == Sequence();
    const bool neverPosted = Sequence() == 0 && msg->_seenSource != _identity;
    if (stampsEqual && (samePost || neverPosted))
    {
        MarkAsCurrent(*msg);
        return false;
    }
    return CopyToMessage(*msg);
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
    const std::lock_guard<std::mutex> lock(*_mutex);
    return CopyToMessage(*msg);
}

// For the message that the global copy was just cloned from. If somebody posted in between, it is not
// current.
void PublishSubscribeMessage::AttachAsCurrent(RabitMessage &msg)
{
    const std::lock_guard<std::mutex> lock(*_mutex);
    msg._seenSource = 0;
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
