#include "air/AirSchedule.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace Rabit
{
namespace
{

// Presence may send a quarter of a second of the budget in a row before others, but no more than this, in
// bytes.
constexpr double LargestPresenceBurst = 65536.0;
// A driver that came late has caught up 10 ms (AirBudget). So a datagram may have to wait longer than its
// spacing, until the bytes that were caught up leave the last second.
constexpr AirSchedule::Duration PromiseMargin = std::chrono::milliseconds(20);
// Longest time by which a promised datagram is sent early. It is less than the shortest promise
// (BeatPace::DefaultPeriod), so that others get their turn, too.
constexpr AirSchedule::Duration LongestLead = AirBudget::LongestThriftyDatagram;

}  // namespace

AirSchedule::AirSchedule(std::size_t largestDatagram) : _budget(largestDatagram)
{
    LimitChanged();
}

void AirSchedule::SetLimits(std::optional<double> budget, std::optional<double> pace, Duration now)
{
    _budget.SetLimits(budget, pace, now);
    LimitChanged();
}

void AirSchedule::Reserve(double bytesPerSecond)
{
    _budget.Reserve(bytesPerSecond);
}

void AirSchedule::LimitChanged()
{
    const double rate = _budget.Rate().value_or(4.0 * LargestPresenceBurst);
    _shares.SetPresenceBurst(static_cast<std::int64_t>(std::min(rate / 4.0, LargestPresenceBurst)));
}

const AirStream &AirSchedule::At(StreamId id) const
{
    if (id.Index >= _streams.size() || !_streams[id.Index].IsThere || _streams[id.Index].Life != id.Life)
    {
        throw std::out_of_range("AirSchedule: no such stream");
    }
    return _streams[id.Index];
}

AirStream &AirSchedule::At(StreamId id)
{
    return const_cast<AirStream &>(static_cast<const AirSchedule &>(*this).At(id));
}

StreamId AirSchedule::AddStream(TrafficClass traffic, double weight)
{
    if (!(weight >= SmallestWeight && weight <= LargestWeight))
    {
        throw std::invalid_argument("AirSchedule: a weight is from 0.01 to 100");
    }
    if (_free.empty())
    {
        _free.push_back(static_cast<std::uint32_t>(_streams.size()));
        _streams.emplace_back();
    }
    const std::uint32_t index = _free.back();
    _free.pop_back();
    AirStream &stream = _streams[index];
    const std::uint32_t life = stream.Life + 1;
    stream = AirStream{};
    stream.Index = index;
    stream.Life = life;
    stream.IsThere = true;
    stream.Class = traffic;
    stream.Weight = weight;
    return {index, life};
}

void AirSchedule::Remove(StreamId id)
{
    AirStream &stream = At(id);
    StopWaiting(stream);
    _promised = _promised == &stream ? nullptr : _promised;
    stream.IsThere = false;
    _free.push_back(stream.Index);
}

void AirSchedule::StopWaiting(AirStream &stream)
{
    if (stream.HeapPlace != AirStream::NotWaiting)
    {
        QueueOf(stream.Class).Remove(stream);
    }
    _kept = _kept == &stream ? nullptr : _kept;
    _early = _early == &stream ? nullptr : _early;
}

void AirSchedule::Ready(StreamId id, std::size_t bytes)
{
    AirStream &stream = At(id);
    stream.Bytes = bytes;
    if (stream.HeapPlace == AirStream::NotWaiting)
    {
        QueueOf(stream.Class).Add(stream);
    }
}

void AirSchedule::NotReady(StreamId id)
{
    StopWaiting(At(id));
}

void AirSchedule::Promise(StreamId id, std::size_t bytes, Duration deadline)
{
    _promised = &At(id);
    _promised->Bytes = bytes;
    _deadline = deadline;
}

void AirSchedule::MayRide(StreamId id, std::size_t bytes)
{
    _early = &At(id);
    _early->Bytes = bytes;
}

bool AirSchedule::Rides(const AirStream &stream, const Destinations &to, std::size_t room, Duration now)
{
    if (stream.Destinations != to.Number || stream.Bytes > to.Count * (room + JoinedHeaders) ||
        _budget.Room(stream.Bytes, now) < stream.Bytes)
    {
        return false;
    }
    const bool isPromised = _promised == nullptr || _promised == &stream;
    return isPromised || _budget.WhenFits(0, now) + _budget.TimeOf(stream.Bytes) <= _deadline - PromiseMargin;
}

std::optional<StreamId> AirSchedule::NextRider(TrafficClass first, const Destinations &to, std::size_t room,
                                               Duration now)
{
    if (to.Number == 0 || _budget.IsUnlimited() || _kept != nullptr)
    {
        return std::nullopt;
    }
    const auto rider = [&](const AirStream &stream) {
        return Rides(stream, to, room, now) ? std::optional(StreamId{stream.Index, stream.Life})
                                            : std::nullopt;
    };
    if (_early != nullptr && rider(*_early))
    {
        return rider(*_early);
    }
    for (std::size_t i = 0; i < TrafficClassCount; ++i)
    {
        const auto traffic = static_cast<TrafficClass>(i);
        const bool isEntitled =
            first == TrafficClass::Presence || traffic == first || _shares.HasCredit(traffic);
        if (!_queues[i].IsEmpty() && isEntitled)
        {
            const AirStream &stream = _queues[i].First();
            return _queues[i].MayFollow(stream) ? rider(stream) : std::nullopt;
        }
    }
    return std::nullopt;
}

ClassShares::Waiting AirSchedule::Waiting() const
{
    ClassShares::Waiting waiting{};
    for (std::size_t i = 0; i < TrafficClassCount; ++i)
    {
        waiting[i] = !_queues[i].IsEmpty();
    }
    return waiting;
}

bool AirSchedule::IsAnyoneReady() const
{
    return std::any_of(_queues.begin(), _queues.end(),
                       [](const FairQueue &queue) { return !queue.IsEmpty(); });
}

AirStream *AirSchedule::KeptForLong(Duration now) const
{
    return _kept != nullptr && now - _keptSince >= Patience ? _kept : nullptr;
}

// When the promised datagram begins to go before one of the other stream; Never: it does not.
AirSchedule::Duration AirSchedule::MustGoBy(const AirStream &other, Duration now) const
{
    const bool isOtherFirst = &other == _kept && now - _keptSince >= LongestPatience;
    if (_promised == nullptr || _promised == &other || isOtherFirst || _budget.IsUnlimited())
    {
        return Never;
    }
    return _deadline - PromiseMargin - std::min(_budget.TimeOf(other.Bytes), LongestLead);
}

AirStream &AirSchedule::Chosen(Duration now)
{
    AirStream *const kept = KeptForLong(now);
    AirStream &first = kept != nullptr ? *kept : QueueOf(_shares.Next(Waiting())).First();
    return now >= MustGoBy(first, now) ? *_promised : first;
}

// A command that fits before the chosen stream does; null: none. `when`: in: when the chosen one fits; out:
// when the returned one does.
AirStream *AirSchedule::Passing(const AirStream &chosen, Duration now, Duration &when)
{
    FairQueue &commands = QueueOf(TrafficClass::Command);
    if (chosen.Class <= TrafficClass::Command || commands.IsEmpty() || &chosen == KeptForLong(now))
    {
        return nullptr;
    }
    const Duration fits = _budget.WhenFits(commands.First().Bytes, now);
    if (fits >= when || fits >= MustGoBy(commands.First(), now))
    {
        return nullptr;
    }
    when = fits;
    return &commands.First();
}

std::optional<StreamId> AirSchedule::Next(Duration now)
{
    if (!IsAnyoneReady())
    {
        return std::nullopt;
    }
    AirStream &chosen = Chosen(now);
    if (_budget.IsUnlimited())
    {
        return StreamId{chosen.Index, chosen.Life};
    }
    Duration when = _budget.WhenFits(chosen.Bytes, now);
    if (when <= now)
    {
        return StreamId{chosen.Index, chosen.Life};
    }
    // The stream keeps its turn from the time when only its size prevented sending.
    if (_kept == nullptr && _budget.WhenFits(0, now) <= now)
    {
        _kept = &chosen;
        _keptSince = now;
    }
    const AirStream *passing = Passing(chosen, now, when);
    return passing != nullptr && when <= now ? std::optional(StreamId{passing->Index, passing->Life})
                                             : std::nullopt;
}

void AirSchedule::Sent(StreamId id, std::size_t bytes, Duration now)
{
    AirStream &stream = At(id);
    StopWaiting(stream);
    _promised = _promised == &stream ? nullptr : _promised;
    if (bytes == 0)
    {
        return;
    }
    QueueOf(stream.Class).Charge(stream, bytes);
    _shares.Charge(stream.Class, bytes, Waiting());
    _budget.Sent(bytes, now);
    stream.Sent += bytes;
    _sent[static_cast<std::size_t>(stream.Class)] += bytes;
}

AirSchedule::Duration AirSchedule::NextDue(Duration now)
{
    if (!IsAnyoneReady())
    {
        return Never;
    }
    const AirStream &chosen = Chosen(now);
    Duration when = _budget.WhenFits(chosen.Bytes, now);
    Passing(chosen, now, when);
    if (const Duration promised = MustGoBy(chosen, now); promised < when)
    {
        // Next has to mark the chosen stream as kept first, or promised datagrams would pass it for ever.
        const Duration spaced = _budget.WhenFits(0, now);
        when = _kept == nullptr && spaced > now ? std::min(spaced, promised) : promised;
    }
    return when <= now ? now : std::max(when, now + Grain);
}

std::uint64_t AirSchedule::SentBytes(StreamId id) const
{
    return At(id).Sent;
}

}  // namespace Rabit
