#pragma once

#include "RingBuffer.h"

#include <rabit/gateway/links/LinkOptions.h>
#include <rabit/gateway/links/LinkOutcome.h>
#include <rabit/gateway/links/LinkPayload.h>
#include <rabit/gateway/links/LinkTime.h>

#include <cstddef>
#include <cstdint>
#include <string>

namespace Rabit
{

// An accepted message whose outcome is not known, or whose numbers the receiver must still hear of.
struct OutboxMessage
{
    std::uint64_t Id = 0;
    LinkTime ExpiresAt = LinkNever;
    const std::string *Type = nullptr;  // owned by the LinkNode
    std::uint32_t TypeNumber = 0;
    LinkPayload Payload;       // given up when the message has expired
    std::size_t Bytes = 0;     // of the payload; counted until the outcome is known
    bool Redelivered = false;  // was sent to an earlier incarnation of the receiver

    // The parts that were sent: none while End is 0.
    std::uint64_t First = 0;  // number of its first part
    std::uint64_t End = 0;    // the number after its last part so far
    std::size_t Cut = 0;      // bytes in these parts
    bool IsWhole = false;     // the last of these parts ends it: with its last bytes, or as SKIP
    bool IsSkipped = false;   // it expired after a part of it was sent
    bool MayArrive = false;   // its last bytes were sent
    bool IsSettled = false;   // its outcome was reported; its numbers wait for the receiver
};

// A part that was sent, by its number.
struct SentPart
{
    std::uint64_t Message = 0;  // LinkOutbox::Message
    std::size_t Offset = 0;
    std::size_t Length = 0;
    LinkTime SentAt{0};    // last time, in whole microseconds
    std::size_t Cost = 0;  // its share of the bytes under way; 0: it is not under way
    bool IsHeld = false;   // the receiver has it, and waits for others
    bool IsLost = false;   // to be sent again
    bool IsNamed = false;  // the type's name went with it
    bool IsAgain = false;  // was sent more than once
};

// The messages of one link that wait for their outcome, oldest first: those of which parts were sent, then
// those of which none was. Parts are cut and numbered when they are first sent. So a message that expires
// before that leaves at once, and a stream that starts anew has nothing to renumber. Only the newest of the
// sent messages can be there in part.
class LinkOutbox
{
public:
    explicit LinkOutbox(const LinkOptions &options) : _options(options) {}

    bool Empty() const { return _sent.Empty() && _waiting.Empty(); }
    // Messages without an outcome.
    std::size_t Count() const { return UnsettledCount() + _waiting.Size(); }
    std::size_t Bytes() const { return _bytes; }
    // Used share of the room for messages or for bytes, the larger of both; 1: full.
    double Fill() const;
    std::size_t SentCount() const { return _sent.Size(); }
    // Number of sent messages without an outcome.
    std::size_t UnsettledCount() const { return _sent.Size() - _settled; }
    bool HasWaiting() const { return !_waiting.Empty(); }

    // Why a message of this size does not fit; LinkRefusal::None if it fits.
    LinkRefusal Check(std::size_t bytes) const;
    void Add(OutboxMessage message);

    // The number of the next part, and that of the oldest part that is not acknowledged.
    std::uint64_t NextSequence() const { return _nextSequence; }
    std::uint64_t FirstSequence() const { return _nextSequence - _parts.Size(); }
    SentPart &Part(std::uint64_t sequence) { return _parts[sequence - FirstSequence()]; }
    const SentPart &Part(std::uint64_t sequence) const { return _parts[sequence - FirstSequence()]; }

    // Sent messages are numbered from FirstMessage() to NextMessage() - 1.
    std::uint64_t FirstMessage() const { return _nextMessage - _sent.Size(); }
    std::uint64_t NextMessage() const { return _nextMessage; }
    OutboxMessage &Message(std::uint64_t number) { return _sent[number - FirstMessage()]; }
    const OutboxMessage &Message(std::uint64_t number) const { return _sent[number - FirstMessage()]; }
    OutboxMessage &MessageOf(const SentPart &part) { return Message(part.Message); }
    const OutboxMessage &MessageOf(const SentPart &part) const { return Message(part.Message); }

    // True if only a part of the newest sent message was cut: it continues before another message begins.
    bool IsInPart() const { return !_sent.Empty() && !_sent[_sent.Size() - 1].IsWhole; }
    // True if there is a message to cut the next part from, and that message.
    bool HasMore() const { return IsInPart() || HasWaiting(); }
    const OutboxMessage &Next() const { return IsInPart() ? _sent[_sent.Size() - 1] : _waiting.Front(); }
    // The number of Next() among the sent messages, now or once a part of it is cut.
    std::uint64_t NextIs() const { return IsInPart() ? _nextMessage - 1 : _nextMessage; }
    // Bytes of everything that can be cut, plus `forEach` for each message. Stops counting at `enough`.
    std::size_t BytesToCut(std::size_t enough, std::size_t forEach) const;
    // Cuts the next `bytes` bytes of Next() as a part. Returns its number.
    std::uint64_t Cut(std::size_t bytes);
    // Ends the newest sent message, of which only a part was cut, with one more part, a SKIP.
    std::uint64_t CutSkip();

    // The oldest sent message without an outcome; null: none. Then tells its outcome: its payload and its
    // place in the outbox are given up, and its numbers are skipped.
    OutboxMessage *FirstUnsettled();
    const OutboxMessage *FirstUnsettled() const;
    void Settle(OutboxMessage &message);

    // The oldest message that was never sent. There must be one.
    const OutboxMessage &FirstWaiting() const { return _waiting.Front(); }
    // Takes out the oldest part / sent message / message never sent. There must be one.
    SentPart TakePart() { return _parts.PopFront(); }
    OutboxMessage TakeSent();
    OutboxMessage TakeWaiting();
    // The newest sent message waits again as if nothing of it had been sent. There must be one, and no parts.
    void ReturnLastSent();

private:
    const LinkOptions &_options;
    RingBuffer<OutboxMessage> _sent;
    RingBuffer<OutboxMessage> _waiting;
    RingBuffer<SentPart> _parts;
    std::size_t _bytes = 0;    // of messages without an outcome
    std::size_t _settled = 0;  // the oldest of the sent ones
    std::uint64_t _nextSequence = 1;
    std::uint64_t _nextMessage = 1;
};

}  // namespace Rabit
