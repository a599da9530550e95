#pragma once

#include "RingBuffer.h"

#include <rabit/gateway/links/LinkOptions.h>
#include <rabit/gateway/links/LinkOutcome.h>
#include <rabit/gateway/links/LinkPayload.h>
#include <rabit/gateway/links/LinkTime.h>

#include <cstdint>
#include <string>

namespace Rabit
{

// An accepted message whose outcome is not known.
struct OutboxMessage
{
    std::uint64_t Id = 0;
    LinkTime ExpiresAt = LinkNever;
    const std::string *Type = nullptr;  // owned by the LinkNode
    LinkPayload Payload;                // given up when the message has expired
    std::size_t Bytes = 0;              // of the payload; counted until the outcome is known
    bool Redelivered = false;           // was sent to an earlier life of the receiver
    LinkTime SentAt{0};                 // for the last time, as LinkData::SentAt says
};

// The messages of one link that wait for their outcome, oldest first: those that were sent and have sequence
// numbers, then those that were never sent and have none yet. A number is given when a message is first sent.
// So a message that expires before that leaves at once, and a stream that starts anew has nothing to
// renumber.
class LinkOutbox
{
public:
    explicit LinkOutbox(const LinkOptions &options) : _options(options) {}

    bool Empty() const { return _sent.Empty() && _waiting.Empty(); }
    std::size_t Count() const { return _sent.Size() + _waiting.Size(); }
    std::size_t Bytes() const { return _bytes; }
    std::size_t SentCount() const { return _sent.Size(); }
    bool HasWaiting() const { return !_waiting.Empty(); }

    // Whether a message of this size fits, and if not, why.
    LinkRefusal Check(std::size_t bytes) const;
    void Add(OutboxMessage message);

    // The sequence number that the next message sent for the first time will get, and that of the oldest one
    // sent.
    std::uint64_t NextSequence() const { return _nextSequence; }
    std::uint64_t FirstSequence() const { return _nextSequence - _sent.Size(); }

    // A message that was sent, by its number: FirstSequence() to NextSequence() - 1.
    OutboxMessage &Sent(std::uint64_t sequence) { return _sent[sequence - FirstSequence()]; }
    const OutboxMessage &Sent(std::uint64_t sequence) const { return _sent[sequence - FirstSequence()]; }
    // The oldest that was never sent. There must be one.
    const OutboxMessage &FirstWaiting() const { return _waiting.Front(); }
    // Gives the oldest message that was never sent its number. There must be one.
    void NumberFirstWaiting();

    // Takes out the oldest sent message / the oldest never sent. There must be one.
    OutboxMessage TakeSent();
    OutboxMessage TakeWaiting();
    // Makes the newest sent message the oldest waiting one again. There must be one.
    void ReturnLastSent();

private:
    const LinkOptions &_options;
    RingBuffer<OutboxMessage> _sent;
    RingBuffer<OutboxMessage> _waiting;
    std::size_t _bytes = 0;
    std::uint64_t _nextSequence = 1;
};

}  // namespace Rabit
