// Datagrams for the guard, in each of its modes.
#include "Input.h"
#include "guard/JoinMessages.h"
#include "guard/RtpsGuard.h"

using Rabit::Rtps::RtpsGuard;

// Byte 0: the mode. Then datagrams, each behind its size and the seconds since the one before.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size)
{
    Fuzz::Input input(data, size);
    constexpr RtpsGuard::Mode modes[] = {RtpsGuard::Mode::Full, RtpsGuard::Mode::StructureOnly,
                                         RtpsGuard::Mode::Secured, RtpsGuard::Mode::Protected};
    const unsigned choice = input.Byte();
    RtpsGuard guard(modes[choice % 4], std::chrono::seconds(1));
    RtpsGuard::TimePoint now{std::chrono::hours(1)};
    const Rabit::Rtps::HostAddress from = {127, 0, 0, 1};
    while (!input.IsEmpty())
    {
        now += std::chrono::seconds(input.Byte() % 8);
        auto datagram = input.Part();
        if ((choice & 4) != 0)
        {
            guard.Sending(datagram);
        }
        std::vector<std::vector<std::uint8_t>> delivered;
        guard.Admit(datagram, from, now,
                    [&](std::span<std::uint8_t> message)
                    {
                        Fuzz::Require(Rabit::Rtps::HasRtpsHeader(message));
                        delivered.emplace_back(message.begin(), message.end());
                    });
        std::vector<std::uint8_t> buffer(65536);
        Fuzz::Require(Rabit::Rtps::JoinMessages(delivered, buffer, 0) <= buffer.size());
    }
    return 0;
}
