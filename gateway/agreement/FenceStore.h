#pragma once

#include <cstdint>

namespace Rabit
{

// Where a voter keeps the highest fence that it may have accepted, so that fences rise over its restarts.
class FenceStore
{
public:
    virtual ~FenceStore() = default;
    // All fences up to this one may have been accepted; 0: none was. Called once, at the start.
    virtual std::uint64_t Load() = 0;
    // Stores that. Returns false if it could not: the voter then accepts no fence above the one before.
    virtual bool Store(std::uint64_t upTo) = 0;
};

}  // namespace Rabit
