// Nodes with keys on a medium in virtual time. The medium has a rate, a delay, losses and copies from a seed.
// All datagrams go to all nodes. Each node sends a beat from time to time, once it runs.
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <rabit/base/Earliest.h>

#include "common/RtpsReader.h"
#include "envelope/SealNodes.h"
#include "envelope/SealedCore.h"

namespace SealedFleets
{

using namespace std::chrono_literals;
using namespace SealNodes;
using Duration = TimePoint::duration;

struct Medium
{
    double Loss = 0.0;    // of each datagram at each receiver
    double Copies = 0.0;  // of each datagram at each receiver
    double BitsPerSecond = 10e6;
    Duration Delay = 2ms;
    Duration Beat = 500ms;
    std::uint64_t Seed = 1;
    // Bytes a second of introductions for which the holder of each node gives turns; 0: it gives none.
    double Turns = 0.0;
};

class SealedFleet
{
public:
    struct Node
    {
        std::string Name;
        std::uint8_t Number = 0;  // of keys, certificate and addresses
        std::shared_ptr<Member> Keys;
        std::unique_ptr<SealedCore> Core;  // null: it does not run
        RtpsHeader Vendor{};
        std::map<std::size_t, TimePoint> Heard;  // the last beat of each node
        std::vector<std::string> Logs;
        std::size_t Stored = 0;
        bool MayStore = true;
        std::int64_t Utc = 1'800'000'000;
        int Openings = 0;
        TimePoint NextTurn{};
    };

    explicit SealedFleet(const Medium &medium = {}) : _medium(medium), _random(medium.Seed) {}

    // Adds a node that does not run yet. Nodes with the same number have the same keys.
    std::size_t Add(std::string name, std::uint8_t number, const std::vector<Bytes> &bulletins,
                    CertificateRole role = CertificateRole::Node)
    {
        Nodes.push_back(std::make_unique<Node>());
        const std::size_t index = Nodes.size() - 1;
        Node &node = *Nodes.back();
        node.Name = std::move(name);
        node.Number = number;
        MakeMember(index, bulletins, role);
        return index;
    }
    void MakeMember(std::size_t index, const std::vector<Bytes> &bulletins,
                    CertificateRole role = CertificateRole::Node)
    {
        Node &node = *Nodes[index];
        const Bytes list = ListOf(node.Number);
        auto made = Member::Make(
            {.SigningKey = SeedOf(3, node.Number).Bytes(),
             .AgreementKey = SeedOf(4, node.Number).Bytes(),
             .Certificate = WriteCertificate({.Name = node.Name,
                                              .Role = role,
                                              .Number = node.Number,
                                              .Begins = 1'700'000'000,
                                              .Ends = 2'000'000'000,
                                              .Signing = SigningKey::Of(SeedOf(3, node.Number))->Public(),
                                              .Agreement = AgreementKey::Of(SeedOf(4, node.Number))->Public(),
                                              .Permissions = Permissions::HashOf(list)},
                                             Signs.Signing),
             .Permissions = list,
             .Authority = Signs.Signing.Public(),
             .Bulletins = bulletins,
             .Store =
                 [&node](std::uint16_t, std::span<const std::uint8_t>)
             {
                 node.Stored += node.MayStore ? 1 : 0;
                 return node.MayStore;
             }},
            {.Steady = [this] { return Now; }, .Utc = [&node] { return node.Utc; }});
        if (!made.Of)
        {
            throw std::runtime_error(made.Error);
        }
        node.Keys = std::move(made.Of);
    }
    // A list of about 300 bytes that differs for each node.
    static Bytes ListOf(std::uint8_t number)
    {
        std::vector<Permissions::Rule> rules;
        for (int topic = 0; topic < 10; ++topic)
        {
            rules.push_back(
                {.Topic = "fleet/node" + std::to_string(number) + "/topic" + std::to_string(topic),
                 .MayWrite = true,
                 .MayRead = true});
        }
        return Permissions::Of(std::move(rules))->Bytes();
    }
    // The bulletin of an epoch for the nodes of these numbers.
    Bytes BulletinOf(Epoch epoch, const std::vector<Serial> &numbers, std::vector<Serial> revoked = {})
    {
        std::vector<BulletinNode> all;
        for (const Serial number : numbers)
        {
            const auto node = static_cast<std::uint8_t>(number);
            all.push_back({.Number = number, .Agreement = AgreementKey::Of(SeedOf(4, node))->Public()});
        }
        const auto purpose = static_cast<std::uint8_t>(epoch);
        return Bulletin::Write(epoch, std::move(revoked), std::move(all), SeedOf(1, purpose),
                               *AgreementKey::Of(SeedOf(5, purpose)), Signs.Signing);
    }

    // Opens a new session of the node.
    void StartNode(std::size_t index)
    {
        Node &node = *Nodes[index];
        node.Vendor = HeaderOf(node.Number);
        node.Vendor[Prefix + 4] = static_cast<std::uint8_t>(++node.Openings);
        node.Vendor[Prefix + 5] = static_cast<std::uint8_t>(index);
        RtpsHeader own = node.Vendor;
        const std::array<std::uint8_t, Prefix> ours{'R', 'T', 'P', 'S', 2, 2, 'R', 'b'};
        std::copy(ours.begin(), ours.end(), own.begin());
        node.Core = SealedCore::Make(
            node.Keys, {node.Vendor, own},
            [this](std::span<std::uint8_t> bytes)
            {
                std::generate(bytes.begin(), bytes.end(),
                              [this] { return static_cast<std::uint8_t>(_random()); });
                return true;
            },
            Now);
        if (!node.Core)
        {
            throw std::runtime_error("no core");
        }
        At(Now + _medium.Beat * static_cast<int>(index % 10) / 10,
           [this, index, opening = node.Openings] { Beat(index, opening); });
    }
    void StartAll()
    {
        for (std::size_t index = 0; index < Nodes.size(); ++index)
        {
            StartNode(index);
        }
    }

    void At(TimePoint time, std::function<void()> work) { _events.emplace(time, std::move(work)); }
    // Runs until `time`.
    void RunTo(TimePoint time)
    {
        while (Step(time))
        {
        }
        Now = std::max(Now, time);
    }
    void Run(Duration time) { RunTo(Now + time); }
    // Runs until it holds, at most for `limit`. Returns how long it took; the limit and more: it never held.
    template <typename Holds>
    Duration RunUntil(const Holds &holds, Duration limit)
    {
        const TimePoint start = Now;
        while (!holds())
        {
            if (!Step(start + limit))
            {
                Now = start + limit;
                return limit + 1s;
            }
        }
        return Now - start;
    }
    // Nothing happens in this time: all that was on its way is lost.
    void Jump(Duration time)
    {
        std::vector<std::pair<TimePoint, std::function<void()>>> beats;
        ++_jumps;
        for (auto &[at, work] : std::exchange(_events, {}))
        {
            beats.emplace_back(at + time, std::move(work));
        }
        Now += time;
        for (auto &[at, work] : beats)
        {
            _events.emplace(at, std::move(work));
        }
    }

    bool IsOpen(std::size_t to, std::size_t from) const
    {
        return Nodes[to]->Core && Nodes[from]->Core && Nodes[to]->Core->IsOpenTo(PrefixOfNode(from), Now);
    }
    bool AreAllOpen() const
    {
        for (std::size_t to = 0; to < Nodes.size(); ++to)
        {
            for (std::size_t from = 0; from < Nodes.size(); ++from)
            {
                if (to != from && !IsOpen(to, from))
                {
                    return false;
                }
            }
        }
        return true;
    }
    Rabit::Rtps::GuidPrefix PrefixOfNode(std::size_t index) const
    {
        return Rabit::Rtps::PrefixOf(std::span(Nodes[index]->Vendor).subspan(Prefix));
    }
    static Rabit::Rtps::Place PlaceOf(std::size_t index)
    {
        return {.Host = {10, 0, 0, static_cast<std::uint8_t>(index + 1)}, .Port = 7410};
    }

    // Gives a datagram to one node. Returns the message that comes out.
    Bytes Inject(std::size_t to, Bytes datagram, std::size_t from = 200)
    {
        const auto message = Nodes[to]->Core->Open(datagram, PlaceOf(from), Now);
        return BytesOf(message);
    }
    // Sends a datagram as that node, to all.
    void Send(std::size_t from, const Bytes &datagram)
    {
        const std::size_t size = datagram.size() + SharedPace::IpAndUdp;
        const auto air = std::chrono::duration_cast<Duration>(
            std::chrono::duration<double>(static_cast<double>(size) * 8.0 / _medium.BitsPerSecond));
        _free = std::max(_free, Now) + air;
        for (std::size_t to = 0; to < Nodes.size(); ++to)
        {
            if (to == from || !Hears(from, to) || Uniform() < _medium.Loss)
            {
                continue;
            }
            const int copies = Uniform() < _medium.Copies ? 2 : 1;
            for (int copy = 0; copy < copies; ++copy)
            {
                At(_free + _medium.Delay * (1 + 5 * copy),
                   [this, from, to, datagram, jumps = _jumps] { Deliver(from, to, datagram, jumps); });
            }
        }
        if (Records)
        {
            Recorded.push_back(datagram);
        }
    }

    Authority Signs;
    std::vector<std::unique_ptr<Node>> Nodes;
    TimePoint Now = Start;
    std::function<bool(std::size_t from, std::size_t to)> Hears = [](std::size_t, std::size_t)
    { return true; };
    bool Records = false;
    std::vector<Bytes> Recorded;
    std::size_t OwnBytes = 0;  // claims and blobs that were sent, with the headers of IP and UDP
    std::map<std::size_t, std::size_t> OwnBytesOf;
    std::size_t Misjudged = 0;  // datagrams of other sizes than SealedCore::DueBytes said, but for padding

private:
    double Uniform() { return static_cast<double>(_random() >> 11) * 0x1p-53; }

    void Beat(std::size_t index, int opening)
    {
        Node &node = *Nodes[index];
        if (!node.Core || node.Openings != opening)
        {
            return;
        }
        Bytes sealed;
        if (node.Core->Seal(MessageOf(node.Vendor, 64), std::nullopt, OuterClass::Traffic, sealed, Now))
        {
            Send(index, sealed);
        }
        At(Now + _medium.Beat, [this, index, opening = node.Openings] { Beat(index, opening); });
    }
    void Deliver(std::size_t from, std::size_t to, Bytes datagram, int jumps)
    {
        Node &node = *Nodes[to];
        if (!node.Core || jumps != _jumps)
        {
            return;
        }
        if (!node.Core->Open(datagram, PlaceOf(from), Now).empty())
        {
            node.Heard[from] = Now;
        }
    }
    static std::optional<TimePoint> DueOf(const Node &node)
    {
        if (!node.Core)
        {
            return std::nullopt;
        }
        const auto network = node.Core->NetworkDue();
        return Rabit::Earliest({node.Core->LocalDue(),
                                network ? std::optional(std::max(*network, node.NextTurn)) : std::nullopt});
    }
    void SendDue(std::size_t index)
    {
        constexpr std::size_t padding = 32;
        Node &node = *Nodes[index];
        if (Now < node.NextTurn)
        {
            return;
        }
        const std::size_t said = node.Core->DueBytes(Now);
        if (const auto sealed = node.Core->TakeDue(Now))
        {
            const std::size_t size = sealed->size() + SharedPace::IpAndUdp;
            Misjudged += size < said || size > said + padding ? 1 : 0;
            OwnBytes += size;
            OwnBytesOf[index] += size;
            if (_medium.Turns > 0.0)
            {
                node.NextTurn = Now + std::chrono::duration_cast<Duration>(std::chrono::duration<double>(
                                          static_cast<double>(size) / _medium.Turns));
            }
            Send(index, *sealed);
        }
    }
    // Does what is due next, unless it is after `end`.
    bool Step(TimePoint end)
    {
        std::optional<TimePoint> next;
        Node *due = nullptr;
        std::size_t dueIndex = 0;
        for (std::size_t index = 0; index < Nodes.size(); ++index)
        {
            const auto at = DueOf(*Nodes[index]);
            if (at && (!next || *at < *next))
            {
                next = at;
                due = Nodes[index].get();
                dueIndex = index;
            }
        }
        const bool isEvent = !_events.empty() && (!next || _events.begin()->first <= *next);
        next = isEvent ? std::optional(_events.begin()->first) : next;
        if (!next || *next > end)
        {
            return false;
        }
        Now = std::max(Now, *next);
        if (isEvent)
        {
            const auto work = std::move(_events.begin()->second);
            _events.erase(_events.begin());
            work();
            return true;
        }
        due->Core->Learn();
        SendDue(dueIndex);
        for (std::string &line : due->Core->TakeLogs())
        {
            due->Logs.push_back(std::move(line));
        }
        return true;
    }

    const Medium _medium;
    std::mt19937_64 _random;
    std::multimap<TimePoint, std::function<void()>> _events;
    TimePoint _free{};
    int _jumps = 0;
};

// Nodes of the numbers 1, 2 ... in epoch 1, which do not run yet.
inline std::unique_ptr<SealedFleet> FleetOf(std::size_t count, const Medium &medium = {})
{
    auto fleet = std::make_unique<SealedFleet>(medium);
    std::vector<Serial> numbers;
    for (std::size_t number = 1; number <= count; ++number)
    {
        numbers.push_back(static_cast<Serial>(number));
    }
    const Bytes first = fleet->BulletinOf(1, numbers);
    for (const Serial number : numbers)
    {
        fleet->Add("uav" + std::to_string(number), static_cast<std::uint8_t>(number), {first});
    }
    return fleet;
}

}  // namespace SealedFleets
