#include <rabit/RabitMessage.h>

#include <rabit/GlobalPublishSubscribeException.h>
#include <rabit/RabitManagerTrace.h>

#include <boost/core/demangle.hpp>

#include <limits>
#include <utility>

namespace Rabit
{

RabitMessage::RabitMessage()
{
    Stamp(SystemTimeClock::GetSystemTimeClock()->Now());
}

RabitMessage::~RabitMessage() = default;

void RabitMessage::CopyBase(const RabitMessage *msg)
{
    if (msg == nullptr)
    {
        return;
    }
    RabitMessage::operator=(*msg);
    if (!_globalPublishSubscribeMessageRef)
    {
        _globalPublishSubscribeMessageRef = msg->_globalPublishSubscribeMessageRef;
    }
}

void RabitMessage::Clear()
{
    MessageType = 0;
    MessageSource = 0;
    MessageDestination = 0;
    SetTimeStamp(0.0);
    _seenSource = 0;
    _seenSequence = 0;
    _postedAt = NeverPosted;
    _redelivered = false;
}

std::string RabitMessage::ToString() const
{
    std::ostringstream text;
    text.precision(17);
    text << boost::core::demangle(typeid(*this).name()) << " at " << _timeStamp << " s";
    return text.str();
}

int RabitMessage::Serialize(std::uint8_t *, int, int)
{
    return 0;
}

int RabitMessage::DeSerialize(std::uint8_t *, int, int)
{
    return 0;
}

std::shared_ptr<PublishSubscribeMessage> RabitMessage::GetGlobalPublishSubscribeMessageRef()
{
    return _globalPublishSubscribeMessageRef;
}

void RabitMessage::SetGlobalPublishSubscribeMessageRef(std::shared_ptr<PublishSubscribeMessage> val)
{
    _globalPublishSubscribeMessageRef = std::move(val);
}

std::type_index RabitMessage::GetTypeIndex()
{
    return typeid(*this);
}

void RabitMessage::SetTimeNow()
{
    const RabitClock *const clock =
        _globalPublishSubscribeMessageRef ? &_globalPublishSubscribeMessageRef->GetClock() : nullptr;
    if (clock == nullptr || (clock == RabitClock::System().get() && RabitManagerTrace::Current() == nullptr))
    {
        Stamp(SystemTimeClock::GetSystemTimeClock()->Now());
    }
    else
    {
        SetTimeStamp(clock->GpsTimeSeconds());
    }
    // Makes the next fetch compare the nanoseconds, too.
    _seenTimeStamp = std::numeric_limits<double>::quiet_NaN();
}

void RabitMessage::Stamp(const PostTime &time)
{
    _timeStamp = time.GpsTimeSeconds;
    _exactStamp = time.GpsTime;
}

// Zero if the time stamp is known as a double only.
std::chrono::nanoseconds RabitMessage::ExactStamp() const
{
    return RabitClock::ToSeconds(_exactStamp) == _timeStamp ? _exactStamp : std::chrono::nanoseconds::zero();
}

double RabitMessage::GetTimeStamp() const
{
    return _timeStamp;
}

void RabitMessage::SetTimeStamp(double gpsTimeSeconds)
{
    Stamp(PostTime{gpsTimeSeconds, {}});
}

double RabitMessage::TimeStampSeconds() const
{
    return _timeStamp;
}

bool RabitMessage::CompareTime(RabitMessage *msg)
{
    if (msg == nullptr || _timeStamp != msg->_timeStamp)
    {
        return false;
    }
    const std::chrono::nanoseconds mine = ExactStamp();
    const std::chrono::nanoseconds theirs = msg->ExactStamp();
    return mine == theirs || mine == mine.zero() || theirs == theirs.zero();
}

double RabitMessage::GetAgeSeconds() const
{
    return GetAgeSeconds(_globalPublishSubscribeMessageRef ? _globalPublishSubscribeMessageRef->GetClock()
                                                           : *RabitClock::System());
}

double RabitMessage::GetAgeSeconds(const RabitClock &clock) const
{
    if (!WasPosted())
    {
        return std::numeric_limits<double>::infinity();
    }
    return std::chrono::duration<double>(clock.Monotonic() - _postedAt).count();
}

PostTime RabitMessage::GetPostTime() const
{
    return PostTime{_timeStamp, WasPosted() ? _postedAt : std::chrono::nanoseconds::zero(), ExactStamp()};
}

void RabitMessage::ThrowNotRegistered() const
{
    throw GlobalPublishSubscribeException(boost::core::demangle(typeid(*this).name()) +
                                          ": the message is not registered under a name");
}

bool RabitMessage::Register_SomethingPublished(const boost::function<void()> &handler)
{
    GlobalOrThrow()._published.Connect(handler, this);
    return true;
}

void RabitMessage::PostMessage(const PostTime &time)
{
    GlobalOrThrow().PostMessage(this, time);
}

void RabitMessage::PostMessageWin()
{
    PostMessage();
}

int RabitMessage::getSerializedMsgHeaderSize()
{
    return 3 * static_cast<int>(sizeof(std::int32_t)) + static_cast<int>(sizeof(double));
}

int RabitMessage::SerializeMsgHeader(ByteArrayWriter &writer)
{
    if (writer.GetNumberBytesAvailable() < getSerializedMsgHeaderSize())
    {
        return 0;
    }
    writer.writeInt32(MessageType);
    writer.writeInt32(MessageSource);
    writer.writeInt32(MessageDestination);
    writer.writeDouble(_timeStamp);
    return getSerializedMsgHeaderSize();
}

int RabitMessage::DeSerializeMsgHeader(ByteArrayReader &reader)
{
    if (reader.GetNumberBytesAvailable() < getSerializedMsgHeaderSize())
    {
        return 0;
    }
    MessageType = reader.readInt32();
    MessageSource = reader.readInt32();
    MessageDestination = reader.readInt32();
    SetTimeStamp(reader.readDouble());
    return getSerializedMsgHeaderSize();
}

}  // namespace Rabit
