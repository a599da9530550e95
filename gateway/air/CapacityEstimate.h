#pragma once

#include <chrono>
#include <cstddef>
#include <optional>

#include "air/DelayReports.h"
#include "air/SentHistory.h"

namespace Rabit
{

// Estimates the capacity of the channel for this node, in bytes a second, where it limits the node. The only
// input is the queueing delay of its datagrams at its peers (delay-based congestion control). Loss is no
// sign: radios lose datagrams.
//
// - Unlimited until the peers agree on a delay above Target.
// - In two cases the delay of what others send limits the node, to FirstRate and to less while the delay is
//   long. Before the first report this is the delay of discovery, if it is above Target. Later it is a delay
//   of all above LongWait, since reports then wait as long. It limits the node until a peer says, later than
//   the long wait began, that nothing of ours is late.
// - Then: the delivery rate while the delay rose, less a part to empty the queue. The delivery rate is the
//   bytes sent between two reported datagrams divided by the time between their arrivals.
// - As long as there is a queue, each report corrects the delivery rate. The rate is below it while the delay
//   is above the goal, and a little above it while the delay is below.
// - The rate rises by the same amount for every node, so that in the end all nodes on one radio have the
//   same.
// - Without a queue it rises more if it is used: gently, and after three quiet seconds by half each second.
// - Never below Floor. A rate of which less than half was used for 20 s, without delays, is out of date: it
//   doubles. After the third doubling without use in between the node is unlimited again.
// - Without reports an unlimited node stays unlimited: a node that hears nobody knows nothing of the air, and
//   a guess would cost every silent wire its speed. Without reports a rate does not rise. After three seconds
//   it falls by a tenth each second, and to a half at most: reports may be missing because of the queue. But
//   if a peer's last report said that nothing is late, and its beats still come without one, then nothing is
//   late: a rate that is used then doubles each second, after three quiet seconds. The apparent queue may
//   have been a computer that stood still.
//
// Sources: the rate is the delivery rate, and the queue is emptied once rather than shared (BBR, Cardwell et
// al. 2016); a target for the delay above the least one, approached in proportion (LEDBAT, RFC 6817); bytes
// in flight show the queue before the next report, and the rise is quicker after a while without congestion
// (SCReAM, RFC 8298); an unused rate does not rise (RFC 7661).
//
// Pure; `now` never goes back; not to be used by two threads at once.
class CapacityEstimate
{
public:
    using Duration = std::chrono::nanoseconds;
    using Peer = DelayReports::Peer;

    static constexpr Duration Target = std::chrono::milliseconds(100);
    static constexpr Duration LongWait = std::chrono::seconds(1);
    static constexpr double Floor = 300.0;       // bytes a second
    static constexpr double FirstRate = 3000.0;  // a share of a thin radio: 250 kbit/s for ten nodes

    // A datagram of `bytes` bytes on the air was sent, scheduled or not.
    void Sent(std::size_t bytes, Duration now) { _sent.Add(bytes, now); }
    // A peer reports that a datagram of ours came by `delay` later than the quickest of ours that it knows.
    // Each report is about a newer datagram than the one before. arrivedAt: the arrival there by our clock if
    // the way took only the delay. That is now, less the time for which the peer has held the report, and
    // less the delay of the report itself. Where the shortest round trip is known, it is subtracted, too. So
    // the datagram was sent at arrivedAt - delay.
    void Reported(Peer peer, Duration delay, Duration arrivedAt, Duration now);

    // A beat of a peer, sent at `sentAt` by our clock, came without a report of our datagrams' delay, though
    // it had room for one. Beats carry reports until three seconds after the last late datagram.
    void NothingLate(Peer peer, Duration sentAt, Duration now);

    // The others' messages of discovery, and all of their datagrams, come here by so much later than the
    // quickest.
    void HeardLate(Duration discovery, Duration all, Duration now);

    // Drops the estimate, for instance when DDS discovery has filled the air: unlimited until peers agree on
    // a delay anew.
    void Forget();

    // Bytes a second; empty: unlimited. Changes with time, too: ask ten times a second while there is a rate.
    std::optional<double> Rate(Duration now) const;
    // The known queue in front of the next datagram.
    Duration Queue(Duration now) const;

private:
    std::optional<double> Carried(const DelayReports::Report &from, const DelayReports::Report &to) const;
    std::optional<double> CarriedOfBurst(const DelayReports::Report &from,
                                         const DelayReports::Report &to) const;
    std::optional<double> CarriedWhileRising(const DelayReports::Reports &said) const;
    void Congested(Duration now);
    void Correct(const DelayReports::Reports &said);
    void Rise(double share, Duration now);
    std::optional<double> RateWhileHeardLate() const;
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
    Duration _discoveryLate{0};
    Duration _allLate{0};
    Duration _longWaitSince{0};  // no earlier
    Duration _nothingLateAt = Duration::min();
    bool _wasReported = false;
};

}  // namespace Rabit
