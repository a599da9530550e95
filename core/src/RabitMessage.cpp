#include <rabit/RabitMessage.h>

#include <rabit/GlobalPublishSubscribeException.h>

#include <boost/core/demangle.hpp>

#include <limits>
#include <utility>

namespace Rabit
{

RabitMessage::RabitMessage() : _timeStamp(SystemTimeClock::GetSystemTimeClock()->GetCurrentGpsTimeInSeconds())
{
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
    _timeStamp = 0.0;
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
    _timeStamp = _globalPublishSubscribeMessageRef
                     ? _globalPublishSubscribeMessageRef->GetClock().GpsTimeSeconds()
                     : SystemTimeClock::GetSystemTimeClock()->GetCurrentGpsTimeInSeconds();
}

double RabitMessage::GetTimeStamp() const
{
    return _timeStamp;
}

void RabitMessage::SetTimeStamp(double gpsTimeSeconds)
{
    _timeStamp = gpsTimeSeconds;
}

double RabitMessage::TimeStampSeconds() const
{
    return _timeStamp;
}

bool RabitMessage::CompareTime(RabitMessage *msg)
{
    return msg != nullptr && _timeStamp == msg->_timeStamp;
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
    return PostTime{_timeStamp, WasPosted() ? _postedAt : std::chrono::nanoseconds::zero()};
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
    _timeStamp = reader.readDouble();
    return getSerializedMsgHeaderSize();
}

}  // namespace Rabit
