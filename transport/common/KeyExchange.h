#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace Rabit
{

// What a datagram is of what two participants with keys say to each other before they can read each other:
// the handshake, the keys, which follow it, and what they can read of each other then.
struct KeyExchange
{
    using Prefix = std::array<std::uint8_t, 12>;  // how the GUID of a participant begins

    // OMG DDS Security 1.1, 9.3.2.5 calls the steps of a handshake so. In the order in which they go: what
    // ends an exchange before what begins one.
    enum class Step : std::uint8_t
    {
        Final,
        Keys,     // 7.4.4: ParticipantVolatileMessageSecure, or its repair
        Control,  // heartbeats and acknowledgements alone
        Reply,
        Ask,  // for a request: AUTH_REQUEST
        Request,
        Rest  // of a handshake's message, which came in fragments
    };

    Prefix From{};
    Prefix To{};  // as INFO_DST says; zero: nobody is named
    Step What = Step::Request;
    // Of keys and control: tells the writers and readers of a participant apart, and what they say.
    std::uint32_t Source = 0;
    // 8.4.2.4: protected as a whole, as all is once keys were exchanged, but these and handshakes.
    bool IsWhole = false;
    // Signed as a whole and nothing else, and of builtin endpoints: of those that discovery has for nodes
    // without keys, and that say nothing where it is protected.
    bool IsIdle = false;
    // Of a handshake's message: that of the sample; its fragments have one.
    std::uint64_t Number = 0;
    // Of a handshake's message: it is for another participant than the one that the datagram is for. There is
    // one writer for all, and Fast DDS says it to all.
    bool IsForOther = false;

    bool IsHandshake() const { return What != Step::Keys && What != Step::Control; }
};

// Empty if it is something else. Of any bytes.
std::optional<KeyExchange> ReadKeyExchange(std::span<const std::uint8_t> datagram);

}  // namespace Rabit
