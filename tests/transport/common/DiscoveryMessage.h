#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

// An RTPS message of discovery, put together part by part.
struct DiscoveryMessage
{
    using Bytes = std::vector<std::uint8_t>;

    static constexpr std::uint8_t AckNack = 0x06;
    static constexpr std::uint8_t Heartbeat = 0x07;
    static constexpr std::uint8_t InfoTimestamp = 0x09;
    static constexpr std::uint8_t InfoDestination = 0x0e;
    static constexpr std::uint8_t Data = 0x15;
    static constexpr std::uint8_t SubscriptionsWriter = 0x04;
    static constexpr std::uint8_t ParticipantWriter = 0x01;

    Bytes Datagram = Bytes(20, 0x52);

    DiscoveryMessage &Add(std::uint8_t kind, const Bytes &body)
    {
        const auto size = body.size();
        for (const std::size_t byte : {std::size_t{kind}, std::size_t{0x01}, size & 0xff, size >> 8})
        {
            Datagram.push_back(static_cast<std::uint8_t>(byte));
        }
        for (const std::uint8_t byte : body)
        {
            Datagram.push_back(byte);
        }
        return *this;
    }
    DiscoveryMessage &To(std::uint8_t participant) { return Add(InfoDestination, Bytes(12, participant)); }
    DiscoveryMessage &At(std::uint8_t time) { return Add(InfoTimestamp, Bytes(8, time)); }
    // Base and count are the last bytes.
    DiscoveryMessage &Acknowledge(std::uint8_t base, std::uint8_t count, std::uint8_t kindOfWriter = 0xc2)
    {
        return Add(AckNack, {0, 0, 4, 0xc7, 0, 0, 4, kindOfWriter, 0, 0, 0, 0, base,
                             0, 0, 0, 0,    0, 0, 0, count,        0, 0, 0});
    }
    DiscoveryMessage &Beat(std::uint8_t last, std::uint8_t count, std::uint8_t writer = SubscriptionsWriter)
    {
        return Add(Heartbeat, {0, 0, writer, 0xc7, 0, 0, writer, 0xc2, 0, 0, 0,     0, 1, 0,
                               0, 0, 0,      0,    0, 0, last,   0,    0, 0, count, 0, 0, 0});
    }
    DiscoveryMessage &Say(std::uint8_t writer, std::uint8_t number, std::uint8_t reader = 0,
                          std::size_t size = 4)
    {
        const std::uint8_t middle = writer == ParticipantWriter ? writer : std::uint8_t{0};
        const std::uint8_t low = writer == ParticipantWriter ? std::uint8_t{0} : writer;
        Bytes body(20 + size, number);
        std::fill_n(body.begin(), 20, std::uint8_t{0});
        body[2] = 16;
        body[7] = reader;
        body[9] = middle;
        body[10] = low;
        body[11] = 0xc2;
        body[16] = number;
        return Add(Data, body);
    }
    DiscoveryMessage &News(std::uint8_t number, std::uint8_t reader = 0, std::size_t size = 4)
    {
        return Say(SubscriptionsWriter, number, reader, size);
    }
};
