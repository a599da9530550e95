// From where one participant speaks, and what was said in its name from elsewhere.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "guard/RtpsMessage.h"

namespace Rabit::Rtps
{

// Discovery says most things once: an endpoint that somebody else announces before its owner, or a number
// that he says is not to be had, is settled for the vendor, and the owner's own word is passed over as a
// repeat of it. So what is said of discovery must come from an address that the participant announced, or
// else be said three times in a row, which an honest one does since it is not received at first. Besides:
// - Who is never heard from an address that it announced (behind an address translation, on a far network of
//   a host with several) speaks from where its announcements come from.
// - 127.0.0.0/8 is this host, whatever was announced: from a network the kernel does not take that
//   (RFC 1122, 3.2.1.3).
// Bounded. Not thread-safe.
class PeerVoice
{
public:
    // What is said: `about` what, and its content. In a row are those about the same.
    struct Saying
    {
        std::uint64_t About = 0;
        std::uint64_t Content = 0;
    };

    // Its announcement was believed, in which it says that it is at these hosts, and which came from `from`.
    // `anew`: for the first time, or since it has moved.
    void Announced(std::span<const HostAddress> hosts, const HostAddress &from, bool anew);
    // Whether it speaks from there. An address that is not known is as good as any.
    bool IsAt(const HostAddress &from) const;
    // Whether that is to be looked at.
    bool Believes(const HostAddress &from, const Saying &saying);

private:
    struct Repeated
    {
        std::uint64_t Content = 0;
        int Times = 0;
    };

    void ForgetOne();

    std::vector<HostAddress> _hosts;
    bool _heardThere = false;          // from one of the hosts
    std::vector<HostAddress> _others;  // where its announcements come from, if it was not
    std::map<std::uint64_t, Repeated> _fromElsewhere;
    std::uint64_t _chance = 0;
};

}  // namespace Rabit::Rtps
