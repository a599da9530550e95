#pragma once

#include <rabit/ByteArrayReaderWriter.h>
#include <rabit/GlobalPublishSubscribeException.h>
#include <rabit/RabitClock.h>
#include <rabit/SystemTimeClock.h>

#include <boost/function.hpp>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <sstream>
#include <string>
#include <typeindex>
#include <typeinfo>

namespace Rabit
{
class PublishSubscribeMessage;

// Base of all messages. A message of a derived class is both what managers share under a name (post and
// fetch) and what they put into queues.
//
// A message object belongs to one thread at a time, usually its manager's; sharing happens through the
// global copy (PublishSubscribeMessage). Registering a message under a name attaches it to that name's
// global copy.
//
// A registration belongs to the object, not to its contents. Assignment, copy or move, takes the contents of
// the other message and keeps the registration of this one: after `*mine = *theirs`, `mine` posts to its own
// name. A message made from another by copy or move is unregistered, and so is the Clone of a generated
// message. CopyBase alone hands a registration on.
class RabitMessage
{
public:
    // For the user; Rabit does not use them.
    int MessageType = 0;
    int MessageSource = 0;
    int MessageDestination = 0;

    // Stamped with the current time of the system clock.
    RabitMessage();
    RabitMessage(const RabitMessage &other) noexcept;
    RabitMessage &operator=(const RabitMessage &other) noexcept;
    virtual ~RabitMessage();

    // A deep copy, of the same dynamic type.
    virtual std::unique_ptr<RabitMessage> Clone() const = 0;
    // Takes over the contents of a message of the same type; returns false and changes nothing if it is of
    // another. The base copies the time stamp and the three ints. Overrides may assign the whole object.
    // The registration stays as it is.
    virtual bool CopyMessage(RabitMessage *msg);
    // Back to default values. The base zeroes the three ints and the time stamp.
    virtual void Clear();
    // For people. The base gives the type's name and the time stamp.
    virtual std::string ToString() const;
    // A private byte format of the derived class; stype is for its own use. Both return the bytes used, 0 if
    // there is no such format (as in the base) or the buffer is too small.
    virtual int Serialize(std::uint8_t *buf, int maxBufSize, int stype = 0);
    virtual int DeSerialize(std::uint8_t *buf, int len, int stype = 0);

    // The global copy that this message is attached to; null if it is not registered.
    std::shared_ptr<PublishSubscribeMessage> GetGlobalPublishSubscribeMessageRef();
    void SetGlobalPublishSubscribeMessageRef(std::shared_ptr<PublishSubscribeMessage> val);

    // Assigns the base of another message. If this message is unregistered, it also takes the registration of
    // the other. For a Clone that makes a new object with it: that clone posts to the name of its original.
    void CopyBase(const RabitMessage *msg);
    // The dynamic type.
    std::type_index GetTypeIndex();

    // The time stamp is in GPS seconds since 1980-01-06. A post sets it.
    //
    // A double holds it in steps of 238 ns, so two posts within a step may have equal doubles. The stamps
    // that Rabit sets are kept in nanoseconds as well, and there they differ. Programs learn from
    // FetchMessage whether there was a post, not from the double.
    void SetTimeNow();
    double GetTimeStamp() const;
    void SetTimeStamp(double gpsTimeSeconds);
    double TimeStampSeconds() const;
    // True when the time stamps are equal: in nanoseconds, or as doubles if one of them was set as a double
    // (SetTimeStamp, a message of another node).
    bool CompareTime(RabitMessage *msg);

    // Seconds since the contents were posted, by the monotonic clock of the workspace (the system's, if the
    // message is not attached): steps of the wall clock do not matter. Infinite if they were never posted.
    double GetAgeSeconds() const;
    // The same by a given clock, which must be the one of the workspace in which the contents were posted.
    double GetAgeSeconds(const RabitClock &clock) const;
    // True if the contents were ever posted: by this message, or by the message that they were fetched or
    // copied from.
    bool WasPosted() const { return _postedAt != NeverPosted; }
    // Time stamp, and the moment of the post by the monotonic clock (zero if there was none).
    PostTime GetPostTime() const;

    // For a message taken from a queue: true if an earlier incarnation of this process may already have got
    // it. Only for messages from other nodes whose sender asked to resend those in doubt; false otherwise.
    bool IsRedelivered() const { return _redelivered; }
    void SetRedelivered(bool redelivered) { _redelivered = redelivered; }

    // These four work on the global copy and throw GlobalPublishSubscribeException if there is none.
    //
    // Has the handler called after each post of this name, with no lock held, for as long as the name
    // exists: on the posting thread. Handlers of posts from other nodes run on a thread of the gateway. One
    // call there may stand for several posts (RabitHandlerThread). Returns true.
    bool Register_SomethingPublished(const boost::function<void()> &handler);
    // Stamps this message with the current time, copies it to the global copy and calls the handlers.
    void PostMessage();
    // Posts with a time that the caller gives, see PublishSubscribeMessage.
    void PostMessage(const PostTime &time);
    void PostMessageWin();
    // Copies the global copy to this message if it is new; returns whether it was. Takes no lock when
    // nothing is new. The first fetch after registering is true if anything was ever posted.
    bool FetchMessage();

    // The common header: the three ints as int32, the time stamp as double.
    int getSerializedMsgHeaderSize();
    // Return the bytes used, 0 if they do not fit.
    int SerializeMsgHeader(ByteArrayWriter &writer);
    int DeSerializeMsgHeader(ByteArrayReader &reader);

protected:
    double _timeStamp;
    std::shared_ptr<PublishSubscribeMessage> _globalPublishSubscribeMessageRef;

private:
    friend class PublishSubscribeMessage;
    friend class RabitWorkspace;
    static constexpr std::chrono::nanoseconds NeverPosted = std::chrono::nanoseconds::min();

    PublishSubscribeMessage &GlobalOrThrow() const;
    [[noreturn]] void ThrowNotRegistered() const;
    void CopyStampFrom(const RabitMessage &msg);
    void Stamp(const PostTime &time);
    std::chrono::nanoseconds ExactStamp() const;

    // In _seenSource: attached, and not fetched yet. The first fetch then copies, even if the time stamps
    // are equal.
    static constexpr std::uint64_t NothingSeenYet = ~std::uint64_t{0};

    // The post that the contents come from: identity and sequence number of the global copy, and their time
    // stamp then. Travels with the time stamp.
    std::uint64_t _seenSource = 0;
    std::uint64_t _seenSequence = 0;
    double _seenTimeStamp = 0.0;
    std::chrono::nanoseconds _postedAt = NeverPosted;
    // PostTime::GpsTime of the time stamp. Void if _timeStamp is not its double: then that was set since.
    std::chrono::nanoseconds _exactStamp{0};
    bool _redelivered = false;
};

}  // namespace Rabit

#include <rabit/PublishSubscribeClass.h>

namespace Rabit
{

// Inline, for these run in every post and fetch.

inline bool PublishSubscribeMessage::FetchMessage(RabitMessage *msg)
{
    if (msg != nullptr && msg->_seenSource == _identity &&
        msg->_seenSequence == _sequence.load(std::memory_order_acquire) &&
        msg->_timeStamp == msg->_seenTimeStamp)
    {
        return false;
    }
    return FetchIfChanged(msg);
}

inline RabitMessage::RabitMessage(const RabitMessage &other) noexcept
{
    RabitMessage::operator=(other);
}

inline RabitMessage &RabitMessage::operator=(const RabitMessage &other) noexcept
{
    MessageType = other.MessageType;
    MessageSource = other.MessageSource;
    MessageDestination = other.MessageDestination;
    CopyStampFrom(other);
    _redelivered = other._redelivered;
    return *this;
}

inline void RabitMessage::CopyStampFrom(const RabitMessage &msg)
{
    _timeStamp = msg._timeStamp;
    _seenSource = msg._seenSource;
    _seenSequence = msg._seenSequence;
    _seenTimeStamp = msg._seenTimeStamp;
    _postedAt = msg._postedAt;
    _exactStamp = msg._exactStamp;
}

inline bool RabitMessage::CopyMessage(RabitMessage *msg)
{
    if (msg == nullptr)
    {
        return false;
    }
    MessageType = msg->MessageType;
    MessageSource = msg->MessageSource;
    MessageDestination = msg->MessageDestination;
    CopyStampFrom(*msg);
    return true;
}

inline PublishSubscribeMessage &RabitMessage::GlobalOrThrow() const
{
    if (!_globalPublishSubscribeMessageRef)
    {
        ThrowNotRegistered();
    }
    return *_globalPublishSubscribeMessageRef;
}

inline void RabitMessage::PostMessage()
{
    GlobalOrThrow().PostMessage(this);
}

inline bool RabitMessage::FetchMessage()
{
    return GlobalOrThrow().FetchMessage(this);
}

}  // namespace Rabit
