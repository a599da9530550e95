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
// that its announcement came from; or else three times in a row. There are hosts with several interfaces on
// one network that announce one and send from another: what they say is not received at first, so they send
// it again. Bounded. Not thread-safe.
class PeerPlace
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
    // Whether that is to be looked at. An address that is not known is as good as any.
    bool Believes(const HostAddress &from, const Saying &saying);

private:
    struct Repeated
    {
        std::uint64_t Content = 0;
        int Times = 0;
    };

    bool IsAt(const HostAddress &from) const;

    std::vector<HostAddress> _hosts;
    std::map<std::uint64_t, Repeated> _fromElsewhere;
};

}  // namespace Rabit::Rtps
