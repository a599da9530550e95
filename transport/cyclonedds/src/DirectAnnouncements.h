#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>

namespace Rabit::Cyclone
{

// Decides which announcements of ours go to one participant alone. The vendor answers each newcomer in that
// way, four times: with each other of a fleet that starts, half of all that is said. An announcement to all
// answers all newcomers at once; only who announces itself to us alone may be out of its reach. Thread-safe.
class DirectAnnouncements
{
public:
    using Address = std::array<std::uint8_t, 4>;  // IPv4
    static constexpr std::size_t MostAddresses = 256;

    // Somebody there has announced itself to us alone.
    void OnAnnouncement(const Address &from);
    bool MayGo(const Address &to) const;

private:
    mutable std::mutex _mutex;
    std::deque<Address> _known;  // guarded by _mutex; the oldest first
};

}  // namespace Rabit::Cyclone
