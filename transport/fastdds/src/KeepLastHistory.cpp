#include "KeepLastHistory.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <mutex>
#include <string_view>

namespace Rabit::FastDds
{

namespace
{

rtps::HistoryAttributes MakeAttributes(int depth)
{
    // Our own pool provides the buffers, so only the changes are reserved here.
    constexpr int MostReserved = 16;
    return {rtps::DYNAMIC_REUSABLE_MEMORY_MODE, 0, std::min(depth + 1, MostReserved), 0};
}

}  // namespace

KeepLastHistory::KeepLastHistory(int depth, bool keepsForLateReaders,
                                 const std::shared_ptr<rtps::IPayloadPool> &pool)
    : SentHistory(MakeAttributes(depth), pool),
      _keepsForLateReaders(keepsForLateReaders),
      _kept(static_cast<std::size_t>(depth))
{
}

bool KeepLastHistory::Add(Change &change, rtps::WriteParams &params,
                          std::chrono::steady_clock::time_point deadline)
{
    const rtps::InstanceHandle_t instance = change.instanceHandle;
    while (const auto oldest = _kept.PushedOut(instance))
    {
        Drop(instance, *oldest);
    }
    // Before it is sent: without readers it is dropped again while being sent.
    const std::uint64_t number = next_sequence_number().to64long();
    _kept.Add(instance, number);
    if (change.kind != rtps::ALIVE)
    {
        while (const auto oldest = _kept.OldestUpTo(instance, _receivedByAll))
        {
            Drop(instance, *oldest);
        }
        // Samples that some reader still lacks are dropped when it has them.
        _kept.End(instance, number);
    }
    if (!add_change_(&change, params, deadline))
    {
        _kept.Remove(instance, number);
        return false;
    }
    return true;
}

void KeepLastHistory::RemoveWriter(rtps::RTPSWriter *writer)
{
    {
        // Version 2.9 frees the samples while they are in the history, and its timer of heartbeats runs on
        // (Fast DDS pull request 4076): it would count from a freed sample's number to the next one's for
        // ever.
        const std::lock_guard lock(writer->getMutex());
        while (!m_changes.empty())
        {
            remove_change_nts(std::prev(m_changes.end()));
        }
    }
    rtps::RTPSDomain::removeRTPSWriter(writer);
}

// Drops only this sample: the vendor is iterating the history, from the newest to the oldest.
void KeepLastHistory::ReceivedByAll(const Change &change)
{
    const std::uint64_t number = change.sequenceNumber.to64long();
    _receivedByAll = std::max(_receivedByAll, number);
    if (!_keepsForLateReaders || _kept.HasEnded(change.instanceHandle, number))
    {
        remove_change_nts(Find(number));
    }
}

void KeepLastHistory::Drop(const rtps::InstanceHandle_t &instance, std::uint64_t number)
{
    remove_change_nts(Find(number));
    _kept.Remove(instance, number);  // even if the history had lost it, so that the caller's loop ends
}

void KeepLastHistory::OnRemoval(const Change &change)
{
    _kept.Remove(change.instanceHandle, change.sequenceNumber.to64long());
}

KeepLastHistory::iterator KeepLastHistory::Find(std::uint64_t number)
{
    const auto found = std::lower_bound(m_changes.begin(), m_changes.end(), number,
                                        [](const Change *kept, std::uint64_t wanted)
                                        { return kept->sequenceNumber.to64long() < wanted; });
    return found != m_changes.end() && (*found)->sequenceNumber.to64long() == number ? found
                                                                                     : m_changes.end();
}

std::size_t KeepLastHistory::HashOf::operator()(const rtps::InstanceHandle_t &instance) const
{
    const rtps::octet *bytes = instance.value;
    return std::hash<std::string_view>()({reinterpret_cast<const char *>(bytes), 16});
}

}  // namespace Rabit::FastDds
