#pragma once

#include <rabit/base/Backoff.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "agreement/AgreementSettings.h"
#include "agreement/ClaimMessages.h"

namespace Rabit
{

// The lease of a claimant: its session, its renewals and when each was sent, and what each voter
// acknowledged. A voter that acknowledged a renewal keeps its book for a lease from when that renewal was
// *sent*, at least.
//
// A pure state machine. Not thread-safe.
class ClaimLease
{
public:
    using Duration = AgreementSettings::Duration;

    enum class Answer : std::uint8_t
    {
        Ignored,  // late, or for another session
        OfKnownBook,
        OfNewBook  // the voter has no grants of this session
    };

    // The settings must outlive the object. Functions for a voter that is no member throw std::out_of_range.
    explicit ClaimLease(const AgreementSettings &settings);

    // Renewals go from now on. Without effect if they go already.
    void Begin(Duration now);
    void Pause() { _renewAt.reset(); }
    // When to renew; empty: not at all.
    std::optional<Duration> RenewAt() const { return _renewAt; }
    // Returns a renewal for all voters. The next one is due sooner if half of the lease has passed. If no
    // majority answers for a lease, the intervals double, up to a lease.
    ClaimRequest Renew(Duration now);
    // Returns a renewal that rides in a beat. A datagram is due only once somewhat more than half of the
    // lease has passed.
    ClaimRequest RenewByBeat(Duration now);
    // Returns a request for orders to a voter whose book is known. It renews the lease, too.
    ClaimRequest OrdersTo(std::string_view voter, Duration now);

    // A voter whose lease has passed may name any book: without storage, and if its wall clock was set back,
    // its incarnation falls over a restart.
    Answer Take(std::string_view from, const ClaimReply &reply, Duration now);
    std::uint32_t Session() const { return _session; }
    bool KnowsBookOf(std::string_view voter) const { return Of(voter).Book != 0; }
    // The end of the lease that this voter acknowledged; 0: of none.
    Duration UntilOf(std::string_view voter) const { return Of(voter).Until; }
    // The end of the lease that a majority acknowledged, of these voters alone; 0: they are no majority.
    Duration UntilOf(const std::vector<std::string_view> &voters) const;

    // All books of the session are left to end.
    void EndSession();

private:
    struct Voter
    {
        std::uint64_t Incarnation = 0;
        std::uint64_t Book = 0;  // 0: not known
        Duration Until{0};
    };

    const Voter &Of(std::string_view voter) const { return _voters.at(std::string(voter)); }
    ClaimRequest NewRequest(Duration now);
    // From then on, less than half of a lease is left of what a majority acknowledged; with beats somewhat
    // less.
    Duration LateAfter() const;
    bool IsLate(Duration now) const { return now > LateAfter(); }
    Duration OfMajority(std::vector<Duration> ends) const;

    const AgreementSettings &_settings;
    const std::uint64_t _group;
    Backoff _hasty;  // intervals while it is late
    std::uint32_t _session = 1;
    std::uint32_t _renewal = 0;
    std::uint32_t _number = 0;
    // When the last renewals were sent, the newest at the end.
    std::deque<Duration> _sent;
    std::optional<Duration> _renewAt;
    bool _ridesInBeats = false;
    std::map<std::string, Voter, std::less<>> _voters;
};

}  // namespace Rabit
