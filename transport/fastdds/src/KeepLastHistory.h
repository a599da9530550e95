// A writer's history: the last samples, of each instance if the topic is keyed, without those that no reader
// needs any more.
#pragma once

#include <chrono>
#include <cstddef>

#include "KeepLast.h"
#include "Vendor.h"

namespace Rabit::FastDds
{

// Guarded by the writer's mutex.
class KeepLastHistory final : public SentHistory
{
public:
    using Change = rtps::CacheChange_t;

    // `keepsForLateReaders`: samples that all matched readers have are kept for late readers.
    KeepLastHistory(int depth, bool keepsForLateReaders, const std::shared_ptr<rtps::IPayloadPool> &pool);

    // Drops the oldest samples that the new one pushes out, then adds and sends it. If the new one disposes
    // its instance, drops all samples of the instance that all readers have. Returns false if it was not
    // added; the caller then still owns the change.
    bool Add(Change &change, rtps::WriteParams &params, std::chrono::steady_clock::time_point deadline);
    // All matched readers have this sample. Drops this sample alone, if it is no longer needed: it is not
    // kept for late readers, or it or a later one has ended the instance. May be called while it is being
    // added.
    void ReceivedByAll(const Change &change);
    // Removes the history's writer from its participant. Call without the writer's mutex, and only if nothing
    // writes any more.
    void RemoveWriter(rtps::RTPSWriter *writer);

private:
    void OnRemoval(const Change &change) override;

    struct HashOf
    {
        std::size_t operator()(const rtps::InstanceHandle_t &instance) const;
    };

    iterator Find(std::uint64_t number);
    void Drop(const rtps::InstanceHandle_t &instance, std::uint64_t number);

    const bool _keepsForLateReaders;
    std::uint64_t _receivedByAll = 0;  // highest number passed to ReceivedByAll

    // A topic without a key has a single instance.
    KeepLast<rtps::InstanceHandle_t, HashOf> _kept;
};

}  // namespace Rabit::FastDds
