#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <variant>

#include "common/RecentMap.h"

namespace Rabit::Cyclone
{

// Decides which of our announcements go to one participant alone. The vendor answers each newcomer in that
// way, four times: half of all traffic when a fleet starts. An announcement to all answers all newcomers at
// once. Only a newcomer that announces itself to us alone may be out of its reach. Thread-safe.
class DirectAnnouncements
{
public:
    using Address = std::array<std::uint8_t, 4>;  // IPv4
    static constexpr std::size_t MostAddresses = 256;

    // A participant at `from` has announced itself to us alone.
    void OnAnnouncement(const Address &from)
    {
        const std::lock_guard lock(_mutex);
        _known.Put(from, {});
    }
    bool MayGo(const Address &to) const
    {
        const std::lock_guard lock(_mutex);
        return _known.Find(to) != nullptr;
    }

private:
    mutable std::mutex _mutex;
    RecentMap<Address, std::monostate> _known{MostAddresses};  // guarded by _mutex
};

}  // namespace Rabit::Cyclone
