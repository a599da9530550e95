// Datagrams for the guard, in each of its modes.
#include "Input.h"
#include "envelope/JoinMessages.h"
#include "guard/RtpsGuard.h"

using Rabit::Rtps::RtpsGuard;

// Byte 0: the mode. Then datagrams, each behind a byte with the seconds since the one before and its source,
// and behind its size.
int Fuzz::OneInput(const std::uint8_t *data, std::size_t size)
{
    Fuzz::Input input(data, size);
    const unsigned choice = input.Byte();
    RtpsGuard guard((choice & 1) == 0 ? RtpsGuard::Mode::Full : RtpsGuard::Mode::StructureOnly,
                    std::chrono::seconds(1));
    RtpsGuard::TimePoint now{std::chrono::hours(1)};
    std::vector<std::uint8_t> buffer(65536);
    while (!input.IsEmpty())
    {
        const std::uint8_t how = input.Byte();
        now += std::chrono::seconds(how % 8);
        const auto from = (how & 8) == 0
                              ? Rabit::Rtps::HostAddress{127, 0, 0, 1}
                              : Rabit::Rtps::HostAddress{10, 0, 0, static_cast<std::uint8_t>(how >> 4)};
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
        Fuzz::Require(Rabit::Rtps::JoinMessages(delivered, buffer, 0) <= buffer.size());
    }
    return 0;
}
