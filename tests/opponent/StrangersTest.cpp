// Each sequence against a fleet of three nodes in virtual time. README.md lists what is judged.
#include <gtest/gtest.h>
#include <malloc.h>

#include <algorithm>
#include <deque>
#include <map>
#include <memory>
#include <string>

#include "../bench/common/Usage.h"
#include "GuardedNode.h"
#include "Sequence.h"

namespace
{

using namespace std::chrono_literals;
using namespace Opponent;

// The costs and times of the fleet, while the opponent plays or is silent.
struct Outcome
{
    std::uint64_t In = 0;   // bytes of the opponent
    std::uint64_t Out = 0;  // bytes of the three nodes
    std::uint64_t Walked = 0;
    std::uint64_t Allocations = 0;
    std::int64_t Memory = 0;  // growth, in bytes
    std::chrono::milliseconds LongestMeeting{0};
    std::chrono::milliseconds LongestSilence{0};
};

class Network
{
public:
    static constexpr std::chrono::seconds Settled{12};
    static constexpr std::chrono::seconds Played{60};

    Network(const Sequence *sequence, std::uint64_t seed)
        : _player(sequence == nullptr ? nullptr : std::make_unique<Player>(*sequence, seed))
    {
        for (std::uint8_t number = 1; number <= 3; ++number)
        {
            Add(number);
        }
    }

    Outcome Run()
    {
        RunFor(Settled);
        const auto allocations = Rabit::Bench::AllocationsSoFar();
        const auto memory = static_cast<std::int64_t>(LiveBytes());
        const auto out = OutSoFar();
        _plays = _player != nullptr;
        for (std::uint8_t newcomer = 4; newcomer <= 6; ++newcomer)
        {
            RunFor(Played / 3);
            Add(newcomer);
            Outcome_.LongestMeeting = std::max(Outcome_.LongestMeeting, Meet());
            _left += _nodes.back()->SentBytes;
            _nodes.pop_back();
            for (const auto &node : _nodes)
            {
                node->Dds.Beats.erase(_nameOfLast);
            }
        }
        Outcome_.Out = OutSoFar() - out;
        Outcome_.Memory = static_cast<std::int64_t>(LiveBytes()) - memory;
        Outcome_.Allocations = Rabit::Bench::AllocationsSoFar() - allocations;
        for (const auto &node : _nodes)
        {
            Outcome_.Walked += node->Dds.Walked;
        }
        return Outcome_;
    }

private:
    struct UnderWay
    {
        TimePoint At;
        Rabit::Rtps::HostAddress From;
        Bytes Datagram;
    };
    static constexpr std::chrono::seconds LongestWait{5};

    static std::size_t LiveBytes()
    {
        const auto info = mallinfo2();
        return info.uordblks + info.hblkhd;
    }
    void Add(std::uint8_t number)
    {
        const Rabit::Rtps::HostAddress host{10, 77, 0, number};
        _nodes.push_back(std::make_unique<GuardedNode>(
            number, [this, host](const Bytes &datagram) { Carry(host, datagram); }));
        _nameOfLast = _nodes.back()->Name;
    }
    void Carry(const Rabit::Rtps::HostAddress &from, const Bytes &datagram)
    {
        _underWay.push_back({_now + 1ms, from, datagram});
    }
    std::uint64_t OutSoFar() const
    {
        std::uint64_t bytes = _left;
        for (const auto &node : _nodes)
        {
            bytes += node->SentBytes;
        }
        return bytes;
    }
    std::chrono::milliseconds Meet()
    {
        const auto begun = _now;
        const auto all = [this]
        {
            return std::all_of(_nodes.begin(), _nodes.end(),
                               [this](const auto &node) {
                                   return node == _nodes.back() ||
                                          (node->Knows(*_nodes.back()) && _nodes.back()->Knows(*node));
                               });
        };
        while (!all() && _now - begun < LongestWait)
        {
            Step();
        }
        return std::chrono::duration_cast<std::chrono::milliseconds>(_now - begun);
    }
    void RunFor(std::chrono::milliseconds time)
    {
        for (const auto end = _now + time; _now < end;)
        {
            Step();
        }
    }
    void Step()
    {
        if (_plays && (_now - TimePoint(1h)) % TurnTime == 0ms)
        {
            for (Sent &sent : _player->Next(_now))
            {
                Outcome_.In += sent.Datagram.size() + Rabit::Rtps::CardExchange::IpAndUdp;
                Carry({10, 77, 0, static_cast<std::uint8_t>(200 + sent.From)}, sent.Datagram);
            }
        }
        while (!_underWay.empty() && _underWay.front().At <= _now)
        {
            const UnderWay each = std::move(_underWay.front());
            _underWay.pop_front();
            for (const auto &node : _nodes)
            {
                if (node->Host != each.From)
                {
                    node->Arrive(each.Datagram, each.From, _now);
                }
            }
            if (_player && each.From.back() < 200)
            {
                _player->Hears(each.Datagram, _now);
            }
        }
        for (const auto &node : _nodes)
        {
            node->Step(_now);
        }
        NoteSilence();
        _now += 1ms;
    }
    void NoteSilence()
    {
        for (std::size_t i = 0; _plays && i < 3; ++i)
        {
            for (std::size_t j = 0; j < 3; ++j)
            {
                const auto heard = _nodes[i]->Dds.Beats.find(_nodes[j]->Name);
                if (i != j)
                {
                    const auto silent =
                        heard == _nodes[i]->Dds.Beats.end() ? _now - TimePoint(1h) : _now - heard->second;
                    Outcome_.LongestSilence =
                        std::max(Outcome_.LongestSilence,
                                 std::chrono::duration_cast<std::chrono::milliseconds>(silent));
                }
            }
        }
    }

    TimePoint _now{1h};
    std::vector<std::unique_ptr<GuardedNode>> _nodes;
    std::deque<UnderWay> _underWay;
    std::unique_ptr<Player> _player;
    bool _plays = false;
    GuidPrefix _nameOfLast{};
    std::uint64_t _left = 0;
    Outcome Outcome_;
};

// The goals. Traffic, work and memory count for all three nodes together.
constexpr std::int64_t MostMemory = 3 * 10'000'000;
constexpr std::int64_t MostTraffic = 2;  // bytes out for each byte in
// Numbers that the vendors step through, besides ten for each byte in: a burst of 4 million in each node, and
// 262,144 a second after that, which is 7 ms of a processor.
constexpr std::int64_t MostWalked = 3 * ((std::int64_t{1} << 22) + 80 * (std::int64_t{1} << 18));
constexpr std::int64_t MostWalkedPerByte = 10;
constexpr std::int64_t MostAllocations = 10;  // for each byte in
constexpr std::chrono::milliseconds MostMeeting = 2s;
constexpr std::chrono::milliseconds MostSilence = 2s;

// Returns what the opponent got, one word for each goal that was missed.
std::string Gains(const Outcome &quiet, const Outcome &played)
{
    const auto in = static_cast<std::int64_t>(played.In);
    const auto more = [](std::uint64_t with, std::uint64_t without)
    { return static_cast<std::int64_t>(with) - static_cast<std::int64_t>(without); };
    std::string gains;
    const auto judge = [&gains](const char *what, std::int64_t seen, std::int64_t most)
    {
        std::printf("  %-12s %12lld of %lld\n", what, static_cast<long long>(seen),
                    static_cast<long long>(most));
        gains += seen > most ? std::string(gains.empty() ? "" : " ") + what : "";
    };
    judge("memory", played.Memory - quiet.Memory, MostMemory);
    judge("traffic", more(played.Out, quiet.Out), MostTraffic * in);
    judge("walk", more(played.Walked, quiet.Walked), MostWalked + MostWalkedPerByte * in);
    judge("allocations", more(played.Allocations, quiet.Allocations), MostAllocations * in);
    judge("meeting", played.LongestMeeting.count(), MostMeeting.count());
    judge("beats", played.LongestSilence.count(), MostSilence.count());
    return gains;
}

class Strangers : public testing::TestWithParam<Sequence>
{
};

TEST_P(Strangers, GetNothing)
{
    const Outcome quiet = Network(nullptr, 1).Run();
    const Outcome played = Network(&GetParam(), 1).Run();
    EXPECT_GT(played.In, 0u);
    EXPECT_EQ(Gains(quiet, played), "");
}

INSTANTIATE_TEST_SUITE_P(All, Strangers,
                         testing::ValuesIn(Opponent::Strangers().begin(), Opponent::Strangers().end()),
                         [](const auto &each) { return std::string(each.param.Name); });

}  // namespace
