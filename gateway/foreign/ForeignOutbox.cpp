#include "foreign/ForeignOutbox.h"

#include <rabit/idl/MessageTypeRegistry.h>

#include <utility>

#include "names/TypeDefinition.h"

namespace Rabit
{
namespace
{

// Numbers of messages of links begin at 1, and never come up to this one.
constexpr std::uint64_t FirstForeignId = std::uint64_t{1} << 63;
constexpr int BitsOfOutbox = 40;

const std::string ReceiptSubject = "a receipt";

bool EncodeSample(const MessageType &type, const RabitMessage &message, std::vector<std::uint8_t> &sample)
{
    sample.resize(type.SerializedSize(message));
    return type.Serialize(message, sample) == sample.size() && !sample.empty();
}

}  // namespace

ForeignOutbox::ForeignOutbox(const ForeignRule &rule, const MessageType &type, const RabitClock &clock,
                             const SourceClock &source, std::size_t number, WakeUp wake,
                             RabitHandlerThread *handlers, std::shared_ptr<GatewayTap> tap)
    : _rule(rule),
      _type(type),
      _clock(clock),
      _source(source),
      _wake(std::move(wake)),
      _handlers(handlers),
      _tap(std::move(tap)),
      _nextId(FirstForeignId | static_cast<std::uint64_t>(number) << BitsOfOutbox)
{
}

bool ForeignOutbox::Add(const RabitMessage &message, const Receipt &receipt)
{
    if (receipt)
    {
        receipt->Begin(1);
    }
    const MessageType *type = MessageTypeRegistry::Of(message);
    if (type == nullptr)
    {
        return Refuse(receipt, "the message is of a type that was not made from IDL");
    }
    Message added{.Sample = {}, .SourceTime = _source.At(_clock.Monotonic()), .Told = receipt};
    if (!EncodeSample(*type, message, added.Sample))
    {
        return Refuse(receipt, "the message does not fit its IDL type `" + type->Name() +
                                   "`: a bounded string or sequence is too long");
    }
    if (type != &_type && (type->Name() != _type.Name() || DefinitionHash(*type) != DefinitionHash(_type)))
    {
        const std::string reason =
            "the queue `" + _rule.Local + "` takes `" + _type.Name() + "`, not `" + type->Name() + "`";
        TellRefused(type->Name(), added.Sample, reason);
        return Refuse(receipt, reason);
    }
    // For the tap, since the outbox may have sent and dropped the message before the tap is told.
    const std::vector<std::uint8_t> told = _tap ? added.Sample : std::vector<std::uint8_t>();
    std::string reason;
    std::uint64_t id = 0;
    bool isOnly = false;
    {
        const std::lock_guard lock(_mutex);
        const std::size_t bytes = added.Sample.size();
        isOnly = _waiting.empty();
        if (_isClosed)
        {
            reason = "the gateway has ended";
        }
        else if (_waiting.size() >= _rule.Capacity ||
                 (!isOnly && _waitingBytes + bytes > _rule.CapacityBytes))
        {
            reason = "messages come faster than they can be sent, and no more may wait";
        }
        else
        {
            id = added.Id = _nextId++;
            _waitingBytes += bytes;
            _waiting.push_back(std::move(added));
            _reason.clear();
        }
    }
    if (!reason.empty())
    {
        TellRefused(_type.Name(), told, reason);
        return Refuse(receipt, reason);
    }
    if (_tap)
    {
        _tap->Sent({.Node = "", .Queue = _rule.Local, .Type = _type.Name(), .Id = id, .Sample = told});
    }
    if (isOnly)
    {
        _wake();
    }
    return true;
}

bool ForeignOutbox::Refuse(const Receipt &receipt, const std::string &reason)
{
    const Duration now = _clock.Monotonic();
    {
        const std::lock_guard lock(_mutex);
        ++_refused;
        _reason = reason;
        _refusedAt = now;
    }
    if (receipt)
    {
        receipt->Refuse(reason);
    }
    return false;
}

void ForeignOutbox::TellRefused(std::string_view type, const std::vector<std::uint8_t> &sample,
                                const std::string &reason) const
{
    if (_tap)
    {
        _tap->Refused({.Node = "", .Queue = _rule.Local, .Type = type, .Id = 0, .Sample = sample}, reason);
    }
}

// Only the gateway's thread removes messages, and a deque does not move its elements when others are added.
const ForeignOutbox::Message *ForeignOutbox::Front() const
{
    const std::lock_guard lock(_mutex);
    return _waiting.empty() ? nullptr : &_waiting.front();
}

void ForeignOutbox::Pop(QueueOutcome outcome)
{
    Message done;
    {
        const std::lock_guard lock(_mutex);
        done = std::move(_waiting.front());
        _waiting.pop_front();
        _waitingBytes -= done.Sample.size();
    }
    if (_tap)
    {
        _tap->Settled("", _rule.Local, done.Id, outcome);
    }
    if (done.Told)
    {
        const RabitHandlerThread::Scope scope(_handlers, ReceiptSubject, done.Told);
        done.Told->Settle(outcome);
    }
}

std::size_t ForeignOutbox::Close()
{
    {
        const std::lock_guard lock(_mutex);
        _isClosed = true;
    }
    const std::size_t left = Waiting();
    while (Front() != nullptr)
    {
        Pop(QueueOutcome::Expired);
    }
    return left;
}

std::size_t ForeignOutbox::Waiting() const
{
    const std::lock_guard lock(_mutex);
    return _waiting.size();
}

std::uint64_t ForeignOutbox::Refused() const
{
    const std::lock_guard lock(_mutex);
    return _refused;
}

std::string ForeignOutbox::Problem(Duration now) const
{
    const std::lock_guard lock(_mutex);
    return !_reason.empty() && now - _refusedAt < Memory ? "messages are refused: " + _reason : "";
}

}  // namespace Rabit
