#pragma once

#include <chrono>
#include <cstddef>
#include <vector>

#include "envelope/SecretKey.h"
#include "envelope/Types.h"

namespace Rabit::Envelope
{

// The secrets of the newest epochs, and who is revoked. A node sends in the newest epoch. It takes datagrams
// of former epochs for ten minutes after it learned of a newer one, so that a bulletin may reach all nodes.
// Afterwards it takes bulletins alone, from nodes that have not got the newest one. Time is passed in. Not
// thread-safe: sealing and opening read it, each under its own lock. `Learn` needs both locks, that of
// opening first.
class EpochSecrets
{
public:
    static constexpr std::chrono::minutes Overlap{10};
    // A node that missed more bulletins than this needs its next bulletin as a file.
    static constexpr std::size_t Most = 8;

    enum class Use : std::uint8_t
    {
        None,      // unknown, or too old
        Bulletin,  // for bulletins alone
        All
    };

    // Adds an epoch with all serials that are revoked in it. Store a bulletin before this call, so that a
    // restart does not go back. Returns false, and changes nothing, unless the epoch is newer than all known.
    // After a restart, former epochs are added first and live for ten minutes again.
    bool Learn(Epoch epoch, const SecretKey &secret, std::vector<Serial> revoked, TimePoint now);

    // 0: none is known yet.
    Epoch Newest() const { return _known.empty() ? Epoch{0} : _known.back().Number; }
    // Null if the epoch is not among the newest ones.
    const SecretKey *Secret(Epoch epoch) const;
    Use UseOf(Epoch epoch, TimePoint now) const;
    // As the newest epoch says: its list has all that ever were revoked.
    bool IsRevoked(Serial number) const;

private:
    struct Known
    {
        Epoch Number = 0;
        SecretKey Secret;
        TimePoint Learned{};
    };

    const Known *Find(Epoch epoch) const;

    std::vector<Known> _known;     // rising
    std::vector<Serial> _revoked;  // rising
};

}  // namespace Rabit::Envelope
