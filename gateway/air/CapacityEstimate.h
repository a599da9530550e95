#pragma once

#include <chrono>
#include <cstddef>
#include <optional>

#include "air/DelayReports.h"
#include "air/SentHistory.h"

namespace Rabit
{

// How many bytes a second the air carries for this node, as far as that limits it: learned from how late its
// datagrams come to its peers, and from nothing else. Loss says nothing: a radio loses.
//
// - Unlimited until the peers agree on a delay above Target.
// - Then: what was really carried while the delay rose, that is the bytes sent between two reported datagrams
//   by the time between their arrivals, less what it takes to empty the queue.
// - As long as there is a queue, each report corrects what is carried; the rate is below it while the delay
//   is above the goal, and a little above it while it is below.
// - It rises by the same amount for every node, so that in the end nodes on one radio have as much as others.
// - Without a queue it rises more if it is used: gently, and after three quiet seconds by half each second.
// - Never below Floor. A rate of which less than half was used for 20 s, without delays, is out of date: it
//   doubles. After the third doubling without use in between the node is unlimited again.
// - Without reports: what was unlimited stays so, since a node that hears nobody knows nothing of the air,
//   and to guess would cost every silent wire its speed. A rate falls after three seconds, by a tenth each
//   second and to a half at most (reports may be missing because of the queue), and does not rise. But if a
//   peer's last report said that nothing is late, and its beats go on to come without one, nothing is: a rate
//   that is used then doubles each second. What looked like a queue may have been a computer that stood
//   still.
//
// Taken from others: the rate is that of delivery and the queue is emptied once rather than shared (BBR,
// Cardwell et al. 2016); a target for the delay above the least one, approached in proportion (LEDBAT, RFC
// 6817); bytes in flight tell of the queue before the next report does, and the rise is quicker after a while
// without congestion (SCReAM, RFC 8298); a rate that is not used does not rise (RFC 7661).
//
// Pure; `now` never goes back; not to be used by two threads at once.
class CapacityEstimate
{
public:
    using Duration = std::chrono::nanoseconds;
    using Peer = DelayReports::Peer;

    static constexpr Duration Target = std::chrono::milliseconds(100);
    static constexpr double Floor = 300.0;  // bytes a second

    // A datagram of so many bytes on the air went out, scheduled or not.
    void Sent(std::size_t bytes, Duration now) { _sent.Add(bytes, now); }
    // A peer says that a datagram of ours came so much later than the quickest of ours that it knows. Each
    // report is about a newer datagram than the one before. arrivedAt: when that datagram would have arrived
    // there, by our clock, if the way took no time, only the delay: now, less the time for which the peer has
    // held the report, less by how much the report itself came later than the peer's quickest, and less the
    // shortest round trip, where it is known. So it was sent at arrivedAt - delay.
    void Reported(Peer peer, Duration delay, Duration arrivedAt, Duration now);

    // A beat of a peer came that says nothing of how late our datagrams are: it would, for three seconds
    // after the last that was late.
    void NothingLate(Peer peer, Duration now);

    // What was learned says nothing any more, as when DDS has had the air for itself: unlimited until peers
    // agree on a delay anew.
    void Forget();

    // Bytes a second; empty: unlimited. Changes with time, too: ask ten times a second while there is a rate.
    std::optional<double> Rate(Duration now) const;
    // The queue that is in front of the next datagram, as far as known.
    Duration Queue(Duration now) const;

private:
    std::optional<double> Carried(const DelayReports::Report &from, const DelayReports::Report &to) const;
    std::optional<double> CarriedOfBurst(const DelayReports::Report &from,
                                         const DelayReports::Report &to) const;
    std::optional<double> CarriedWhileRising(const DelayReports::Reports &said) const;
    void Congested(Duration now);
    void Correct(const DelayReports::Reports &said);
    void Rise(double share, Duration now);
    bool IsUsed(Duration now) const;
    bool IsUnused(Duration now) const;
    void LoosenIfUnused(Duration now);

    SentHistory _sent;
    DelayReports _reports;
    bool _limited = false;
    bool _agreed = false;      // on a delay above Target
    double _carried = 0.0;     // bytes a second
    Duration _reportedAt{0};   // the last report
    Duration _unusedSince{0};  // at the earliest
    int _doublings = 0;        // for want of use, since the rate was used
    Duration _quietSince{0};   // no delay above the goal since
};

}  // namespace Rabit
