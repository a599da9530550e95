#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "SimRandom.h"
#include "agreement/TableCopy.h"
#include "agreement/TableExchange.h"

namespace Rabit
{

// Nodes with a shared table under simulated time, on a network that loses, delays, repeats and cuts. Each
// beats twice a second.
class TableFleet
{
public:
    using Duration = std::chrono::nanoseconds;

    static constexpr Duration Beat = std::chrono::milliseconds(500);

    struct Network
    {
        double Loss = 0.0;
        double Repeats = 0.0;
        Duration Shortest = std::chrono::milliseconds(1);
        Duration Longest = std::chrono::milliseconds(5);
    };

    Network Air;
    std::size_t Sent = 0;         // datagrams of exchanges, of all nodes
    std::size_t LongestSent = 0;  // in bytes

    TableFleet(std::vector<std::string> names, std::uint64_t seed) : _names(std::move(names)), _random(seed)
    {
        for (const std::string &name : _names)
        {
            Start(name, 1);
        }
    }

    void Start(const std::string &name, std::uint64_t incarnation)
    {
        Node &node = _nodes[name];
        node.Exchange.reset();
        node.Table = std::make_unique<TableCopy>(name, incarnation);
        node.Exchange = std::make_unique<TableExchange>(*node.Table);
        node.BeatAt = _now + _random.Between(Duration(0), Beat);
        node.HeardAt.clear();
    }

    TableCopy &operator[](const std::string &name) { return *_nodes.at(name).Table; }
    const std::vector<std::string> &Names() const { return _names; }

    // Whether the second one hears the first.
    void Block(const std::string &from, const std::string &to, bool isBlocked = true)
    {
        _blocked[{from, to}] = isBlocked;
    }
    // Nodes hear each other if they have the same number.
    void Place(const std::string &name, int island) { _nodes[name].Island = island; }
    // No node hears another one.
    void Part()
    {
        int island = 0;
        for (const std::string &name : _names)
        {
            Place(name, ++island);
        }
    }
    void Join()
    {
        for (const std::string &name : _names)
        {
            Place(name, 0);
        }
        _blocked.clear();
    }

    bool AreEqual() const
    {
        const TableCopy &first = *_nodes.at(_names.front()).Table;
        return std::all_of(_names.begin(), _names.end(),
                           [&](const std::string &name)
                           {
                               const TableCopy &table = *_nodes.at(name).Table;
                               return table.Entries() == first.Entries() && table.Digest() == first.Digest();
                           });
    }

    void RunFor(Duration duration)
    {
        const Duration end = _now + duration;
        for (Duration next = NextEvent(); next <= end; next = NextEvent())
        {
            _now = next;
            SendBeats();
            Deliver();
        }
        _now = end;
    }

private:
    // A peer that was not heard for that long is LOST.
    static constexpr Duration LostAfter = 4 * Beat;

    struct Node
    {
        std::unique_ptr<TableCopy> Table;
        std::unique_ptr<TableExchange> Exchange;
        Duration BeatAt{0};
        int Island = 0;
        std::map<std::string, Duration> HeardAt;
    };
    struct Packet
    {
        std::string From, To;
        std::optional<std::uint64_t> Digest;  // a beat; else a datagram
        std::vector<std::uint8_t> Bytes;
    };

    Duration NextEvent() const
    {
        Duration next = _packets.empty() ? Duration::max() : _packets.begin()->first;
        for (const auto &[name, node] : _nodes)
        {
            next = std::min(next, node.BeatAt);
        }
        return next;
    }

    void SendBeats()
    {
        for (const std::string &name : _names)
        {
            Node &node = _nodes[name];
            if (node.BeatAt > _now)
            {
                continue;
            }
            node.BeatAt += Beat;
            for (const std::string &to : _names)
            {
                if (to != name)
                {
                    Send({name, to, node.Table->Digest(), {}});
                }
            }
        }
    }

    void Send(const Packet &packet)
    {
        if (_nodes[packet.From].Island != _nodes[packet.To].Island || _blocked[{packet.From, packet.To}] ||
            _random.Chance(Air.Loss))
        {
            return;
        }
        for (int copies = _random.Chance(Air.Repeats) ? 2 : 1; copies > 0; --copies)
        {
            _packets.emplace(_now + _random.Between(Air.Shortest, Air.Longest), packet);
        }
    }

    void Deliver()
    {
        while (!_packets.empty() && _packets.begin()->first <= _now)
        {
            const Packet packet = std::move(_packets.begin()->second);
            _packets.erase(_packets.begin());
            Node &to = _nodes[packet.To];
            if (packet.Digest)
            {
                const auto heard = to.HeardAt.find(packet.From);
                if (heard != to.HeardAt.end() && _now - heard->second > LostAfter)
                {
                    to.Exchange->ForgetUnless([&packet](const std::string &peer)
                                              { return peer != packet.From; });
                }
                to.HeardAt[packet.From] = _now;
                to.Exchange->OnDigest(packet.From, *packet.Digest, _now);
            }
            else
            {
                to.Exchange->OnDatagram(packet.From, packet.Bytes, _now);
            }
            while (auto datagram = to.Exchange->TakeDatagram([](const auto &) { return true; }))
            {
                ++Sent;
                LongestSent = std::max(LongestSent, datagram->Bytes.size());
                Send({packet.To, datagram->To, std::nullopt, std::move(datagram->Bytes)});
            }
        }
    }

    const std::vector<std::string> _names;
    std::map<std::string, Node> _nodes;
    Sim::SimRandom _random;
    std::map<std::pair<std::string, std::string>, bool> _blocked;
    Duration _now{0};
    std::multimap<Duration, Packet> _packets;
};

}  // namespace Rabit
