#include "rtps/MeetingThread.h"

#include <rabit/base/Earliest.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace Rabit::Rtps
{

void MeetingThread::Start(Calls calls)
{
    _calls = std::move(calls);
    _turns->SetExchange(*this);
    DueThread::Start();
}

void MeetingThread::Stop()
{
    _turns->RemoveExchange(*this);
    DueThread::Stop();
}

// Does the task, and wakes the thread if something is now due earlier than it would wake by itself.
template <typename Task>
auto MeetingThread::With(const Task &task)
{
    struct Waker
    {
        MeetingThread &Self;
        ~Waker() { Self.WakeIfEarlier(); }
    };
    const std::lock_guard lock(_mutex);
    const Waker waker{*this};
    return task(Clock::now());
}

void MeetingThread::SetSelf(const GuidPrefix &self)
{
    With([&](auto) { _meeting.SetSelf(self); });
}

bool MeetingThread::IsSelf(const GuidPrefix &participant) const
{
    const std::lock_guard lock(_mutex);
    return _meeting.IsSelf(participant);
}

bool MeetingThread::Sending(std::span<const std::uint8_t> datagram)
{
    return With([&](auto now) { return _meeting.Sending(datagram, now); });
}

bool MeetingThread::Received(std::span<const std::uint8_t> datagram, const HostAddress &from, bool isKnownAt)
{
    return With([&](auto now) { return _meeting.Received(datagram, from, isKnownAt, now); });
}

void MeetingThread::Lost(const GuidPrefix &peer)
{
    With([&](auto) { _meeting.Lost(peer); });
}

bool MeetingThread::WasEnded(const GuidPrefix &peer) const
{
    const std::lock_guard lock(_mutex);
    return _meeting.WasEnded(peer);
}

std::optional<SettingsProblem> MeetingThread::Problem() const
{
    const std::lock_guard lock(_mutex);
    const auto full = _meeting.CardIsFull();
    if (!full)
    {
        return std::nullopt;
    }
    return SettingsProblem{
        .Setting = "endpoints",
        .Entry = "",
        .Text = "this node has " + std::to_string(full->Endpoints) +
                " writers and readers, and other nodes are told of the first " +
                std::to_string(full->InCard) +
                ", which is the most that one node can announce: publish, subscribe, accept and send less, "
                "or divide it into several nodes"};
}

void MeetingThread::HeardUnknown(const GuidPrefix &peer)
{
    With([&](auto now) { _meeting.HeardUnknown(peer, now); });
}

void MeetingThread::Announced(const GuidPrefix &peer, bool hasCard)
{
    With([&](auto now) { _meeting.Announced(peer, hasCard, now); });
}

void MeetingThread::Gone(const GuidPrefix &peer)
{
    With([&](auto now) { _meeting.SaidGoodbye(peer, now); });
}

void MeetingThread::Spoke(const GuidPrefix &peer)
{
    const std::lock_guard lock(_mutex);
    _meeting.Spoke(peer);
}

bool MeetingThread::IsReplayed(const GuidPrefix &peer) const
{
    const std::lock_guard lock(_mutex);
    return _meeting.IsReplayed(peer);
}

std::size_t MeetingThread::NextBytes()
{
    const std::lock_guard lock(_mutex);
    const std::size_t bytes = _meeting.NetworkBytes(Clock::now());
    if (bytes == 0)
    {
        WakeIfEarlier();  // to wait for the next one
    }
    return bytes;
}

void MeetingThread::SendNext()
{
    std::optional<CardExchange::Outgoing> outgoing;
    {
        const std::lock_guard lock(_mutex);
        outgoing = _meeting.TakeForNetwork(Clock::now());
    }
    if (outgoing)
    {
        _calls.Send(outgoing->To, outgoing->Bytes);
    }
}

std::chrono::nanoseconds MeetingThread::QueueingDelay() const
{
    const std::lock_guard lock(_mutex);
    return _meeting.QueueingDelay(Clock::now());
}

// A message that waits for its turn is no work of the thread.
std::optional<MeetingThread::Clock::time_point> MeetingThread::Due()
{
    const bool waitsForTurn = _turns->IsScheduled() && _turns->IsDue();
    return Earliest({_meeting.LocalDue(), waitsForTurn ? std::nullopt : _meeting.NetworkDue(),
                     _meeting.AnyEndable() ? std::optional(_lookAt) : std::nullopt});
}

void MeetingThread::Work(std::unique_lock<std::mutex> &lock)
{
    const auto now = Clock::now();
    if (!_meeting.Endable().empty() && now >= _lookAt)
    {
        _lookAt = now + LookForSilent;
        lock.unlock();
        EndSilent();
        lock.lock();
        return;
    }
    std::vector<Meeting::Local> messages = _meeting.TakeLocal(now);
    const bool isForNetwork = IsBy(_meeting.NetworkDue(), now);
    lock.unlock();
    for (Meeting::Local &local : messages)
    {
        _calls.Deliver(local.From, local.Bytes);
    }
    if (isForNetwork)
    {
        _turns->IsScheduled() ? _turns->Due() : SendNext();
    }
    lock.lock();
}

void MeetingThread::EndSilent()
{
    std::vector<GuidPrefix> peers;
    {
        const std::lock_guard lock(_mutex);
        peers = _meeting.Endable();
    }
    // Participants that are no longer known come first.
    std::multimap<Clock::time_point, GuidPrefix> silent;
    for (const GuidPrefix &peer : peers)
    {
        const auto heard = _calls.LastHeard(peer).value_or(Clock::time_point{});
        if (Clock::now() - heard >= _meeting.EndAfter())
        {
            silent.emplace(heard, peer);
        }
    }
    for (const auto &[heard, peer] : silent)
    {
        const std::lock_guard lock(_mutex);
        const auto endable = _meeting.Endable();
        if (std::find(endable.begin(), endable.end(), peer) != endable.end())
        {
            _meeting.End(peer);
        }
    }
}

}  // namespace Rabit::Rtps
