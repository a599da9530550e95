#include "backfill/Mail.h"

#include <rabit/gateway/ConfigError.h>
#include <rabit/idl/MessageType.h>

#include <algorithm>

namespace Rabit::Backfill
{
namespace
{

template <typename Message>
std::optional<Message> Decoded(const GatewayTap::QueueMessage &message)
{
    const MessageType &type = Message::IdlType();
    Message decoded;
    if (message.Type != type.Name() || !type.Deserialize(message.Sample, decoded))
    {
        return std::nullopt;
    }
    return decoded;
}

bool IsOurs(std::string_view queue)
{
    return queue == QueueName;
}

}  // namespace

std::shared_ptr<Mail> Mail::For(GatewayConfig &config)
{
    for (const AcceptRule &rule : config.Accept)
    {
        if (IsOurs(rule.Queue))
        {
            throw ConfigError(config.File, rule.Line,
                              std::string("the queue `") + QueueName +
                                  "` belongs to the recording and to `fetch`; give this one another name");
        }
    }
    config.Accept.push_back(
        {.Queue = QueueName, .Types = {Question::IdlType().Name(), Answer::IdlType().Name()}, .From = {"*"}});
    SendRule rule;
    rule.Queue = QueueName;
    rule.Class = TrafficClass::Bulk;
    rule.Expire = Expiry;
    config.Send.insert(config.Send.begin(), rule);
    auto mail = std::make_shared<Mail>(config.Tap);
    config.Tap = mail;
    return mail;
}

std::vector<Mail::Letter> Mail::Take()
{
    const std::lock_guard lock(_mutex);
    return std::exchange(_letters, {});
}

std::uint64_t Mail::Incarnation() const
{
    const std::lock_guard lock(_mutex);
    return _incarnation;
}

std::optional<std::chrono::nanoseconds> Mail::SourceToLocal(const std::string &node,
                                                            std::uint64_t incarnation) const
{
    const std::lock_guard lock(_mutex);
    if (const auto known = _clocks.find({node, incarnation}); known != _clocks.end())
    {
        return known->second;
    }
    // The newest of the others.
    const auto after = _clocks.upper_bound({node, ~std::uint64_t{0}});
    return after != _clocks.begin() && std::prev(after)->first.first == node
               ? std::optional(std::prev(after)->second)
               : std::nullopt;
}

void Mail::Sent(const QueueMessage &message)
{
    if (_other && !IsOurs(message.Queue))
    {
        _other->Sent(message);
    }
}

void Mail::Refused(const QueueMessage &message, std::string_view reason)
{
    if (_other && !IsOurs(message.Queue))
    {
        _other->Refused(message, reason);
    }
}

void Mail::Settled(std::string_view node, std::string_view queue, std::uint64_t id, QueueOutcome outcome)
{
    if (_other && !IsOurs(queue))
    {
        _other->Settled(node, queue, id, outcome);
    }
}

void Mail::Received(const QueueMessage &message)
{
    if (!IsOurs(message.Queue))
    {
        if (_other)
        {
            _other->Received(message);
        }
        return;
    }
    Letter letter{.Node = std::string(message.Node),
                  .Asked = Decoded<Question>(message),
                  .Answered = Decoded<Answer>(message)};
    const std::lock_guard lock(_mutex);
    if (_letters.size() < MostLetters && (letter.Asked || letter.Answered))
    {
        _letters.push_back(std::move(letter));
    }
}

void Mail::Mirrored(const MirroredSample &sample)
{
    if (_other)
    {
        _other->Mirrored(sample);
    }
    if (OnMirrored)
    {
        OnMirrored(sample);
    }
}

void Mail::Clocks(std::uint64_t incarnation, std::chrono::nanoseconds sourceAhead,
                  const std::vector<PeerClock> &peers)
{
    {
        const std::lock_guard lock(_mutex);
        _incarnation = incarnation;
        for (const PeerClock &peer : peers)
        {
            if (_clocks.size() < MostClocks || _clocks.contains({peer.Node, peer.Incarnation}))
            {
                _clocks[{peer.Node, peer.Incarnation}] = peer.ToLocal;
            }
        }
    }
    if (_other)
    {
        _other->Clocks(incarnation, sourceAhead, peers);
    }
}

std::vector<Gateway::Problem> Mail::Problems()
{
    std::vector<Gateway::Problem> problems = _other ? _other->Problems() : std::vector<Gateway::Problem>();
    if (OwnProblems)
    {
        for (Gateway::Problem &problem : OwnProblems())
        {
            problems.push_back(std::move(problem));
        }
    }
    return problems;
}

}  // namespace Rabit::Backfill
