#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "SimRandom.h"
#include "agreement/AgreementNode.h"

namespace Rabit
{

// Members of an agreement under simulated time, each with a clock of its own, on a network that loses,
// delays, repeats and cuts. An oracle in true time looks at each gain: a claim has one holder at most, fences
// rise with each holder, and a loss is told before another one gains.
class ClaimFleet
{
public:
    using Duration = std::chrono::nanoseconds;

    struct Network
    {
        double Loss = 0.0;
        double Repeats = 0.0;
        Duration Shortest = std::chrono::milliseconds(1);
        Duration Longest = std::chrono::milliseconds(5);
    };

    Network Air;
    // Of each node; 0: there are no beats. Before Start.
    Duration BeatPeriod{0};
    std::vector<std::string> Violations;
    std::map<std::string, std::size_t> Sent;  // datagrams of each node; one for all counts once

    ClaimFleet(std::vector<std::string> names, std::uint64_t seed) : _names(std::move(names)), _random(seed)
    {
        for (const std::string &name : _names)
        {
            _members[name].Lists = _names;
        }
    }

    // How much faster that node's clock runs than true time. Before Start.
    void SetDrift(const std::string &name, double drift) { _members[name].Rate = 1.0 + drift; }
    void SetList(const std::string &name, std::vector<std::string> list)
    {
        _members[name].Lists = std::move(list);
    }

    void StartAll()
    {
        for (const std::string &name : _names)
        {
            Start(name);
        }
    }
    void Start(const std::string &name)
    {
        Member &member = _members[name];
        ++member.Incarnation;
        // Nodes do not beat at the same moment.
        const auto place = std::find(_names.begin(), _names.end(), name) - _names.begin();
        member.NextBeat = _now + BeatPeriod * place / static_cast<std::int64_t>(_names.size());
        member.Node = std::make_unique<AgreementNode>(
            AgreementSettings{.Self = name, .Incarnation = member.Incarnation, .Members = member.Lists},
            member.Fences, [this] { return _random.Next(); }, Local(member));
        for (const std::string &claim : member.Keeps)
        {
            member.Node->Own().Want(claim, true, Local(member));
        }
    }
    void Kill(const std::string &name)
    {
        Member &member = _members[name];
        member.Node.reset();
        member.Told.clear();
    }
    // As Kill, but in order.
    void Stop(const std::string &name)
    {
        Member &member = _members[name];
        for (const AgreementNode::Datagram &last : member.Node->Leave(Local(member)))
        {
            Send(name, last);
        }
        Kill(name);
    }
    void LoseStorage(const std::string &name) { _members[name].Fences = 0; }
    bool IsUp(const std::string &name) const { return _members.at(name).Node != nullptr; }
    // A suspended process does nothing, and its clock runs on. A frozen one does not know of that time.
    void Suspend(const std::string &name, bool isSuspended) { _members[name].IsSuspended = isSuspended; }
    void Freeze(const std::string &name)
    {
        Suspend(name, true);
        _members[name].FrozenAt = _now;
    }
    void Thaw(const std::string &name)
    {
        Suspend(name, false);
        Member &member = _members[name];
        member.Slept += _now - *std::exchange(member.FrozenAt, std::nullopt);
    }

    void Want(const std::string &name, const std::string &claim, bool keeps = true)
    {
        Member &member = _members[name];
        if (keeps)
        {
            member.Keeps.push_back(claim);
        }
        if (member.Node)
        {
            EXPECT_TRUE(member.Node->Own().Want(claim, keeps, Local(member)));
        }
    }
    void GiveUp(const std::string &name, const std::string &claim)
    {
        Member &member = _members[name];
        std::erase(member.Keeps, claim);
        if (member.Node)
        {
            member.Node->Own().GiveUp(claim, Local(member));
            EndHolding(claim, name);
        }
    }

    // Whether the second one hears the first.
    void Block(const std::string &from, const std::string &to, bool isBlocked = true)
    {
        _blocked[{from, to}] = isBlocked;
    }
    // Nodes hear each other if they have the same number.
    void Place(const std::string &name, int island) { _members[name].Island = island; }
    void Join()
    {
        for (auto &[name, member] : _members)
        {
            member.Island = 0;
        }
        _blocked.clear();
    }

    AgreementNode &operator[](const std::string &name) { return *_members.at(name).Node; }
    Duration Now() const { return _now; }
    Duration LocalOf(const std::string &name) const { return Local(_members.at(name)); }

    std::vector<std::string> HoldersOf(const std::string &claim) const
    {
        std::vector<std::string> holders;
        for (const auto &[name, member] : _members)
        {
            if (member.Node && member.Node->Own().FenceOf(claim, Local(member)))
            {
                holders.push_back(name);
            }
        }
        return holders;
    }
    // The events that a node has told so far, without its former lives.
    const std::vector<OwnClaims::Event> &ToldBy(const std::string &name) const
    {
        return _members.at(name).Told;
    }

    void RunFor(Duration duration)
    {
        const Duration end = _now + duration;
        while (true)
        {
            ServeAll();
            const Duration next = std::min(NextEvent(), end);
            _now = std::max(next, _now);
            Deliver();
            if (_now >= end)
            {
                ServeAll();
                return;
            }
        }
    }
    // Runs until the claim has a holder, for that long at most; returns the time that it took.
    std::optional<Duration> UntilHeld(const std::string &claim, Duration most)
    {
        const Duration begin = _now;
        while (HoldersOf(claim).empty())
        {
            if (_now - begin >= most)
            {
                return std::nullopt;
            }
            RunFor(std::chrono::milliseconds(1));
        }
        return _now - begin;
    }
    Sim::SimRandom &Random() { return _random; }

private:
    // Shortest time between two looks at a node that says that something is due.
    static constexpr Duration Tick = std::chrono::microseconds(100);

    struct Member
    {
        std::unique_ptr<AgreementNode> Node;
        std::vector<std::string> Lists;
        std::uint64_t Fences = 0;  // stored
        std::uint64_t Incarnation = 0;
        double Rate = 1.0;
        Duration Slept{0};
        std::optional<Duration> FrozenAt;
        bool IsSuspended = false;
        int Island = 0;
        std::vector<std::string> Keeps;
        std::vector<OwnClaims::Event> Told;
        Duration LookedAt{-1};
        Duration NextBeat{0};
    };
    struct Packet
    {
        std::string From, To;
        std::vector<std::uint8_t> Bytes;
        std::optional<AgreementNode::Beat> Beat{};
        std::uint64_t Incarnation = 0;  // of a beat
    };
    struct Holding
    {
        std::string Node;
        std::uint64_t Incarnation = 0;
    };

    Duration Local(const Member &member) const
    {
        const Duration now = member.FrozenAt.value_or(_now) - member.Slept;
        return Duration(static_cast<std::int64_t>(static_cast<double>(now.count()) * member.Rate));
    }
    Duration TrueOf(const Member &member, Duration local) const
    {
        const auto now =
            static_cast<std::int64_t>(std::ceil(static_cast<double>(local.count()) / member.Rate));
        return Duration(now) + member.Slept;
    }

    Duration NextEvent() const
    {
        Duration next = _packets.empty() ? Duration::max() : _packets.begin()->first;
        for (const auto &[name, member] : _members)
        {
            if (member.Node && !member.IsSuspended)
            {
                next = BeatPeriod > Duration(0) ? std::min(next, member.NextBeat) : next;
                if (const auto due = member.Node->Due())
                {
                    next = std::min(next, std::max(TrueOf(member, *due), member.LookedAt + Tick));
                }
            }
        }
        return next;
    }

    void ServeAll()
    {
        for (auto &[name, member] : _members)
        {
            Serve(name, member);
        }
    }

    void Serve(const std::string &name, Member &member)
    {
        if (!member.Node || member.IsSuspended)
        {
            return;
        }
        member.LookedAt = _now;
        do
        {
            while (auto datagram = member.Node->TakeDue(Local(member)))
            {
                Send(name, *datagram);
            }
        } while (StoreFences(member));
        if (BeatPeriod > Duration(0) && _now >= member.NextBeat)
        {
            member.NextBeat = _now + BeatPeriod;
            const AgreementNode::Beat beat = member.Node->TakeBeat(Local(member));
            for (const std::string &to : _names)
            {
                if (to != name)
                {
                    Send({name, to, {}, beat, member.Incarnation});
                }
            }
        }
        Judge(name, member);
    }

    // Returns true if that may have made answers due.
    bool StoreFences(Member &member)
    {
        const auto upTo = member.Node->StoreWanted();
        if (upTo)
        {
            member.Fences = *upTo;
            member.Node->Stored(*upTo, true, Local(member));
        }
        return upTo.has_value();
    }

    void Send(const std::string &name, const AgreementNode::Datagram &datagram)
    {
        ++Sent[name];
        for (const std::string &to : datagram.To.empty() ? _names : std::vector<std::string>{datagram.To})
        {
            if (to != name)
            {
                Send({name, to, datagram.Bytes, {}, 0});
            }
        }
    }

    void Send(const Packet &packet)
    {
        if (_members[packet.From].Island != _members[packet.To].Island ||
            _blocked[{packet.From, packet.To}] || _random.Chance(Air.Loss))
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
            Member &to = _members[packet.To];
            if (to.Node && !to.IsSuspended)
            {
                if (packet.Beat)
                {
                    to.Node->OnBeat(packet.From, packet.Incarnation, *packet.Beat, Local(to));
                }
                else
                {
                    to.Node->OnDatagram(packet.From, packet.Bytes, Local(to));
                }
                StoreFences(to);
                Judge(packet.To, to);
            }
        }
    }

    void Judge(const std::string &name, Member &member)
    {
        for (OwnClaims::Event &event : member.Node->Own().TakeEvents())
        {
            const bool gained = event.What == OwnClaims::Event::Kind::Gained;
            if (gained)
            {
                JudgeGain(name, member, event);
            }
            else if (event.What == OwnClaims::Event::Kind::Lost)
            {
                EndHolding(event.Claim, name);
            }
            member.Told.push_back(std::move(event));
        }
    }

    void EndHolding(const std::string &claim, const std::string &name)
    {
        const auto holding = _holdings.find(claim);
        if (holding != _holdings.end() && holding->second.Node == name)
        {
            _holdings.erase(holding);
        }
    }

    void JudgeGain(const std::string &name, const Member &member, const OwnClaims::Event &event)
    {
        // A lease is only extended while it lasts, so two may overlap only where one begins.
        if (HoldersOf(event.Claim).size() > 1)
        {
            Violations.push_back(event.Claim + " has two holders at " + std::to_string(_now.count()));
        }
        std::uint64_t &fence = _fences[event.Claim];
        if (event.Fence <= fence)
        {
            Violations.push_back("the fence of " + event.Claim + " did not rise");
        }
        fence = std::max(fence, event.Fence);
        const auto former = _holdings.find(event.Claim);
        if (former != _holdings.end())
        {
            const Member &holder = _members.at(former->second.Node);
            const bool livesOn = holder.Node && holder.Incarnation == former->second.Incarnation;
            if (livesOn && !holder.IsSuspended && former->second.Node != name)
            {
                Violations.push_back(former->second.Node + " was not told that it had lost " + event.Claim);
            }
        }
        _holdings[event.Claim] = {name, member.Incarnation};
    }

    std::vector<std::string> _names;
    std::map<std::string, Member> _members;
    Sim::SimRandom _random;
    std::map<std::pair<std::string, std::string>, bool> _blocked;
    Duration _now{0};
    std::multimap<Duration, Packet> _packets;
    std::map<std::string, std::uint64_t> _fences;
    std::map<std::string, Holding> _holdings;  // as far as was told
};

}  // namespace Rabit
