#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

// A datagram of participant 0x52..., like those with which two participants exchange keys.
struct KeyExchangeMessage
{
    using Bytes = std::vector<std::uint8_t>;

    static constexpr std::uint8_t Self = 0x52;
    Bytes Datagram = Bytes(20, Self);

    KeyExchangeMessage &Add(std::uint8_t kind, const Bytes &body)
    {
        Datagram.insert(Datagram.end(), {kind, 0x01, static_cast<std::uint8_t>(body.size() & 0xff),
                                         static_cast<std::uint8_t>(body.size() >> 8)});
        Datagram.insert(Datagram.end(), body.begin(), body.end());
        return *this;
    }
    KeyExchangeMessage &To(std::uint8_t participant) { return Add(0x0e, Bytes(12, participant)); }
    // A handshake message in a sample of this number.
    KeyExchangeMessage &Handshake(const std::string &step, std::uint8_t number, std::uint8_t addressee,
                                  std::size_t size = 100)
    {
        return Add(0x15, Joined(HeadOf(16, number), ContentOf(step, addressee, size)));
    }
    // A fragment of a handshake message. The first fragment has the content.
    KeyExchangeMessage &Fragment(const std::string &step, std::uint8_t number, std::uint8_t addressee,
                                 std::uint8_t fragment)
    {
        Bytes head = HeadOf(28, number);
        head.insert(head.end(), {fragment, 0, 0, 0, 1, 0, 100, 0, 0, 1, 0, 0});
        return Add(0x16, Joined(head, fragment == 1 ? ContentOf(step, addressee, 100) : Bytes(100, 1)));
    }
    // Submessages encrypted with this key, or in this session if the key is 0.
    KeyExchangeMessage &Encrypted(std::uint8_t key, std::uint8_t session, std::uint8_t size)
    {
        Bytes head(20, 0);
        head[3] = 4;
        head[7] = key;
        head[11] = session;
        return Add(0x31, head).Add(0x30, Bytes(size, 1)).Add(0x32, Bytes(20, 0));
    }
    KeyExchangeMessage &Signed() { return Add(0x33, Bytes(20, 4)); }
    KeyExchangeMessage &Acknowledge(std::uint8_t writer)
    {
        Bytes body(24, 0);
        body[6] = writer;
        body[7] = 0xc2;
        return Add(0x06, body);
    }

private:
    static Bytes Joined(Bytes one, const Bytes &other)
    {
        one.insert(one.end(), other.begin(), other.end());
        return one;
    }
    // The beginning of the body, up to and including the sample's number.
    static Bytes HeadOf(std::uint8_t toInlineQos, std::uint8_t number)
    {
        return {0, 0, toInlineQos, 0, 0, 2, 1, 0xc4, 0, 2, 1, 0xc3, 0, 0, 0, 0, number, 0, 0, 0};
    }
    static Bytes ContentOf(const std::string &step, std::uint8_t addressee, std::size_t size)
    {
        Bytes content(4 + 48 + 12, addressee);
        std::fill_n(content.begin(), 4 + 48, std::uint8_t{0});
        const std::string name = "DDS:Auth:PKI-DH:1.0+" + step;
        content.insert(content.end(), name.begin(), name.end());
        content.resize(std::max(size, content.size()), 0);
        return content;
    }
};
