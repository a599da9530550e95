// RabitMessage.h needs this part of PublishSubscribeMessage.h. It leaves out the headers of Boost that
// programs expect of that one: they are most of what a message's header costs to compile. Programs include
// PublishSubscribeMessage.h.
#pragma once

#include <rabit/RabitClock.h>
#include <rabit/RabitEvent.h>

#include <boost/function.hpp>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>
#include <typeindex>

namespace Rabit
{
class RabitMessage;

// The global copy of a publish-subscribe message: one for each message name of a workspace. Managers hold
// local copies; a post copies local to global, a fetch copies global to local.
//
// A sequence number that rises with each post decides whether a fetch brings something new. Time stamps do
// not: two posts may fall into one tick of the clock. A time stamp that was changed by hand also counts as
// new. Any number of managers may post one name: the posts happen one after the other, each fetch gets the
// last, and a poster fetches what others posted after it.
//
// Threads: all methods may be called from any thread. The messages that are passed in belong to the caller
// and must not be used by another thread during the call. The message's CopyMessage and Clone run under this
// object's lock: they must not post or fetch the same name.
// Errors: a null message throws std::invalid_argument.
class PublishSubscribeMessage
{
public:
    // Takes the message that becomes the global copy. Throws std::invalid_argument if it is null. Without a
    // clock, posts are stamped by the system's.
    PublishSubscribeMessage(std::unique_ptr<RabitMessage> stMessage,
                            std::shared_ptr<const RabitClock> clock = nullptr);
    ~PublishSubscribeMessage();
    PublishSubscribeMessage(const PublishSubscribeMessage &) = delete;
    PublishSubscribeMessage &operator=(const PublishSubscribeMessage &) = delete;

    // The dynamic type of the message.
    std::type_index MsgTypeIndex() const { return _type; }

    // Has the handler called after each post, on the posting thread, or on the RabitHandlerThread that this
    // has for it, and without a lock. For as long as this object lives: use ConnectSomethingPublished to be
    // able to end it.
    void Register_SomethingPublished(const boost::function<void()> &handler);
    // The same, with a connection that ends it.
    RabitConnection ConnectSomethingPublished(RabitHandler handler);

    // A clone of the global copy, registered under no name. Its FetchMessage here returns false until
    // something new is posted.
    std::unique_ptr<RabitMessage> GetCopyOfMessage();

    // Stamps the message with the current time, copies it to the global copy, then calls the handlers. Time
    // stamps of one name strictly increase, by 1 ns if the clock did not move on; as doubles, two that are
    // less than 238 ns apart may be equal. If the wall clock was set back, they follow it. Under the system's
    // clock they run ahead by at most 4 us, then a post waits. Another clock may stand still, so there is no
    // such limit. Throws std::invalid_argument, changing nothing, if the message is of another type and
    // refuses the copy. If CopyMessage throws, that passes to the caller and the post did not happen.
    void PostMessage(RabitMessage *msg);
    // Posts with a time given by the caller: for messages from other nodes, which keep the time of their
    // origin. Readers see the post even if its time repeats or goes back.
    void PostMessage(RabitMessage *msg, const PostTime &time);
    // The same without a copy, for a poster that fills its message anew each time: the message is exchanged
    // for another one of its type, with former contents. Only a registration stays with the poster.
    void PostContents(std::unique_ptr<RabitMessage> &message, const PostTime &time);

    // Copies the global copy to the message if it differs from what the message last posted or fetched
    // here. Returns whether it copied. Takes no lock if there is nothing new. A message that was never
    // posted or fetched here is always copied to, with one exception: if it was never attached either,
    // nothing was ever posted, and the time stamps are equal. False if the message is of another type and
    // refuses the copy.
    bool FetchMessage(RabitMessage *msg);
    // Copies in any case.
    void ForceFetchMessage(RabitMessage *msg);

    // The global copy itself, for tests: reading it is safe only while nobody posts. From the first call
    // on, FetchMessage takes the lock to notice changes that a test makes to the copy.
    const std::unique_ptr<RabitMessage> &GetTestMessage();

    // How many posts there were.
    std::uint64_t GetNumberOfPosts() const { return _sequence.load(std::memory_order_acquire) & ~Exposed; }
    // The clock that stamps the posts.
    const RabitClock &GetClock() const { return *_clock; }

private:
    friend class RabitMessage;
    friend class RabitWorkspace;
    friend class ManagerLease;
    // Set in _sequence once GetTestMessage was called: then no sequence that a message remembers equals it.
    static constexpr std::uint64_t Exposed = std::uint64_t{1} << 63;

    void Post(RabitMessage &msg, PostTime &time, bool byOwnClock);
    RabitEvent::Handlers Publish(const PostTime &time);
    void PostTraced(RabitMessage &msg, const PostTime *time);
    void TellFetched(const RabitMessage &msg) const;
    void PutAfterLast(PostTime &time, std::unique_lock<std::mutex> &lock);
    bool FetchIfChanged(RabitMessage *msg);
    void CopyFromMessage(RabitMessage &msg);
    bool CopyToMessage(RabitMessage &msg);
    bool ForceFetch(RabitMessage *msg);
    void AttachAsCurrent(RabitMessage &msg);
    void Mark(RabitMessage &msg, const PostTime &time, std::uint64_t sequence) const;
    void MarkAsCurrent(RabitMessage &msg) const;
    std::uint64_t Sequence() const { return _sequence.load(std::memory_order_relaxed) & ~Exposed; }

    PostTime Now() const;

    // Read by every fetch without a lock: number of posts, and an identity that no other object ever has.
    std::atomic<std::uint64_t> _sequence{0};
    const std::uint64_t _identity;
    const std::shared_ptr<const RabitClock> _clock;
    const bool _usesSystemClock;

    // Guards what follows, and the list of handlers.
    const std::shared_ptr<std::mutex> _mutex;
    RabitEvent _published;
    std::unique_ptr<RabitMessage> _message;
    const std::type_index _type;
    // The last post that was stamped here: its time by the clock, and its stamp.
    PostTime _lastReading;
    std::chrono::nanoseconds _lastStamp = std::chrono::nanoseconds::min();
};

}  // namespace Rabit
