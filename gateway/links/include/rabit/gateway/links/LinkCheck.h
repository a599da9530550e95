#pragma once

#include <rabit/gateway/links/LinkMessages.h>

#include <cstdint>
#include <string_view>

namespace Rabit
{

// Computes LinkFrame::Check: a 64-bit FNV-1a hash whose halves are folded into 32 bits.
class LinkCheck
{
public:
    LinkCheck &Add(std::string_view bytes)
    {
        for (const char each : bytes)
        {
            AddByte(static_cast<std::uint8_t>(each));
        }
        return *this;
    }
    LinkCheck &Add(std::uint64_t number)
    {
        for (int i = 0; i < 8; ++i)
        {
            AddByte(static_cast<std::uint8_t>(number >> (8 * i)));
        }
        return *this;
    }
    std::uint32_t Value() const { return static_cast<std::uint32_t>(_hash ^ (_hash >> 32)); }

    // The check of a long frame.
    static std::uint32_t OfName(std::string_view destination) { return LinkCheck().Add(destination).Value(); }
    // The check of a short frame, over all that it leaves out.
    static std::uint32_t OfShort(std::string_view destination, std::uint64_t senderLife,
                                 std::uint64_t receiverLife, std::uint32_t clock, std::uint32_t echoClock)
    {
        return LinkCheck()
            .Add(destination)
            .Add(senderLife)
            .Add(receiverLife)
            .Add(clock)
            .Add(echoClock)
            .Value();
    }

private:
    void AddByte(std::uint8_t value) { _hash = (_hash ^ value) * 0x100000001b3ULL; }

    std::uint64_t _hash = 0xcbf29ce484222325ULL;
};

}  // namespace Rabit
