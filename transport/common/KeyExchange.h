#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace Rabit
{

// Description of a datagram by which two participants with keys come to read each other: a handshake, the
// keys that follow it, and the control messages about those keys.
struct KeyExchange
{
    using Prefix = std::array<std::uint8_t, 12>;  // first bytes of a participant's GUID

    // The steps of a handshake, named as in OMG DDS Security 1.1, 9.3.2.5. In the order of priority: messages
    // that end an exchange go before those that begin one.
    enum class Step : std::uint8_t
    {
        Final,
        Keys,     // 7.4.4: ParticipantVolatileMessageSecure, or its repair
        Control,  // heartbeats and acknowledgements alone
        Reply,
        Ask,  // asks for a request: AUTH_REQUEST
        Request,
        Rest  // a later fragment of a handshake's message
    };

    Prefix From{};
    Prefix To{};  // from INFO_DST; zero: no addressee is named
    Step What = Step::Request;
    // For keys and control: identifies a participant's writer or reader and the kind of submessage.
    std::uint32_t Source = 0;
    // 8.4.2.4: protected as a whole. Once keys were exchanged, all datagrams are but keys, control and
    // handshakes.
    bool IsWhole = false;
    // Concerns only those builtin endpoints that no node uses where discovery and liveliness are protected:
    // their protected counterparts (OMG DDS Security 1.1, 7.4.5) are used instead, and no node looks up
    // types.
    bool IsIdle = false;
    // For a handshake's message: the sample's number, common to all its fragments.
    std::uint64_t Number = 0;
    // For a handshake's message: it is for another participant than the datagram. Fast DDS has one writer for
    // all peers and sends each message to all of them.
    bool IsForOther = false;

    bool IsHandshake() const { return What != Step::Keys && What != Step::Control; }
};

// Empty if the datagram is something else. Accepts any bytes.
std::optional<KeyExchange> ReadKeyExchange(std::span<const std::uint8_t> datagram);

}  // namespace Rabit
