// Records, for one reader, which writers have written which living instance of a keyed topic.
#pragma once

#include <cstddef>
#include <cstring>
#include <unordered_map>
#include <vector>

#include <rabit/transport/Transport.h>

namespace Rabit
{

// Tells when an instance has no writer any more (NOT_ALIVE_NO_WRITERS of the OMG DDS
// specification, 2.2.2.5.1.3). Not thread-safe: use it under the reader's gate.
class InstanceTable
{
public:
    void Alive(const KeyHash &key, const WriterId &writer);
    void Disposed(const KeyHash &key) { _writersOf.erase(key); }
    // The writer has unregistered the instance. Returns whether the instance has no writer left; it is
    // forgotten then.
    bool Unregistered(const KeyHash &key, const WriterId &writer);
    // The writer is gone. Returns the instances that have no writer left, and forgets them.
    std::vector<KeyHash> WriterGone(const WriterId &writer);

private:
    struct Hash
    {
        std::size_t operator()(const KeyHash &key) const noexcept
        {
            // The hash is an MD5 or the short key itself, so both halves count.
            std::uint64_t halves[2];
            std::memcpy(halves, key.data(), sizeof halves);
            return static_cast<std::size_t>(halves[0] * 0x9E3779B97F4A7C15ULL ^ halves[1]);
        }
    };
    std::unordered_map<KeyHash, std::vector<WriterId>, Hash> _writersOf;
};

}  // namespace Rabit
