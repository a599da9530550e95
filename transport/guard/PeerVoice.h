// The addresses from which one participant speaks, and claims in its name from other addresses.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "guard/Claim.h"
#include "guard/RtpsMessage.h"

namespace Rabit::Rtps
{

// Discovery sends most data once. If a forger announces an endpoint before its owner does, or declares a
// number absent, the matter is settled for the vendor: it ignores the owner's data as a repeat. So discovery
// data must come from an address that the participant announced, or else arrive three times in a row. An
// honest sender repeats it, since it is not received at first. Besides:
// - A participant that is never heard from an announced address (behind an address translation, on a far
//   network of a host with several) speaks from the addresses from which its announcements come.
// - 127.0.0.0/8 is this host, whatever was announced: the kernel does not accept it from a network (RFC 1122,
//   3.2.1.3).
//
// Bounded. Not thread-safe.
class PeerVoice
{
public:
    // A claim: hash of its subject, and of its content. Repeats are counted for each subject.
    struct Saying
    {
        std::uint64_t About = 0;
        std::uint64_t Content = 0;
    };

    // An announcement of the participant was believed. It names `hosts` and came from `from`. Other hosts
    // than before: the participant has moved.
    void Announced(std::span<const HostAddress> hosts, const HostAddress &from);
    // True if the participant speaks from `from`, or if `from` is unknown.
    bool IsAt(const HostAddress &from) const;
    // True if the claim should be processed.
    bool Believes(const HostAddress &from, const Saying &saying);

private:
    void ForgetOne();

    std::vector<HostAddress> _hosts;
    bool _heardThere = false;          // from one of the hosts
    std::vector<HostAddress> _others;  // the sources of its announcements, if not a host of them
    std::map<std::uint64_t, Claim<std::uint64_t>> _fromElsewhere;  // the content claimed of each subject
    std::uint64_t _chance = 0;
};

}  // namespace Rabit::Rtps
