// A guard, and the messages that it delivers.
#pragma once

#include <chrono>
#include <span>
#include <vector>

#include "guard/RtpsBytes.h"
#include "guard/RtpsGuard.h"

namespace RtpsBytes
{

class Gate
{
public:
    explicit Gate(Rabit::Rtps::RtpsGuard::Mode mode = Rabit::Rtps::RtpsGuard::Mode::Full,
                  Rabit::Rtps::RtpsGuard::Vendor vendor = Rabit::Rtps::RtpsGuard::Vendor::FastDds)
        : _guard(mode, std::chrono::seconds(10), vendor)
    {
    }

    // True if the guard found nothing to count. `Handed` has the messages that it delivered.
    bool Admit(Bytes datagram)
    {
        Handed.clear();
        return _guard.Admit(datagram, From, Now,
                            [this](std::span<std::uint8_t> admitted)
                            { Handed.emplace_back(admitted.begin(), admitted.end()); });
    }
    // True if the datagram gets through unchanged.
    bool Passes(const Bytes &datagram) { return Admit(datagram) && Handed == std::vector<Bytes>{datagram}; }
    // True if nothing of the datagram gets through and the guard counts it.
    bool Stops(const Bytes &datagram) { return !Admit(datagram) && Handed.empty(); }

    void Sending(const Bytes &datagram) { _guard.Sending(datagram); }
    bool TakeReplyDue() { return _guard.TakeReplyDue(); }

    std::vector<Bytes> Handed;
    Rabit::Rtps::RtpsGuard::TimePoint Now{std::chrono::hours(1)};
    Rabit::Rtps::HostAddress From = SenderHost;

private:
    Rabit::Rtps::RtpsGuard _guard;
};

}  // namespace RtpsBytes
