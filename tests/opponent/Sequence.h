// An opponent that keeps state over many datagrams: what it has heard, and the sequences that it tries. No
// sockets, threads or clocks: the holder says what was heard and what time it is, and sends what is returned.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <map>
#include <random>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "guard/RtpsBytes.h"

namespace Opponent
{

using RtpsBytes::Bytes;
using RtpsBytes::EntityId;
using RtpsBytes::GuidPrefix;
using TimePoint = std::chrono::steady_clock::time_point;

// Time between two turns of a sequence.
constexpr std::chrono::milliseconds TurnTime{10};
// Number of source addresses that the opponent holds.
constexpr std::size_t Addresses = 4;

struct Sent
{
    Bytes Datagram;
    std::size_t From = 0;  // which of the opponent's own addresses
};

// The names, numbers and datagrams of others that the opponent has heard.
class Hearing
{
public:
    // The datagrams kept for a replay are the newest ones.
    static constexpr std::size_t MostKept = 4096;

    void Take(std::span<const std::uint8_t> datagram, TimePoint now);

    // The participants that have spoken.
    const std::vector<GuidPrefix> &Names() const { return _names; }
    // The highest number heard of each of the participant's writers.
    const std::map<EntityId, std::int64_t> &NumbersOf(const GuidPrefix &name) const
    {
        return _numbers.at(name);
    }
    const std::deque<std::pair<TimePoint, Bytes>> &Kept() const { return _kept; }

private:
    std::vector<GuidPrefix> _names;
    std::map<GuidPrefix, std::map<EntityId, std::int64_t>> _numbers;
    std::deque<std::pair<TimePoint, Bytes>> _kept;
};

// One turn of a sequence.
struct Turn
{
    std::uint64_t Number;  // from 0 on
    TimePoint Now;
    const Hearing &Heard;
    std::mt19937_64 &Random;
    std::vector<Sent> Out{};

    void Send(Bytes datagram, std::size_t from = 0) { Out.push_back({std::move(datagram), from}); }
    std::uint64_t Below(std::uint64_t limit) { return Random() % limit; }
    // One of the participants that were heard. There must be one.
    const GuidPrefix &AnyName() { return Heard.Names()[Below(Heard.Names().size())]; }
};

struct Sequence
{
    std::string_view Name;
    std::string_view Does;
    void (*Play)(Turn &turn);
};

// All sequences of a stranger, who holds no keys. The last one mixes the others.
std::span<const Sequence> Strangers();

// Plays one sequence. The seed and what is heard decide everything that it sends.
class Player
{
public:
    Player(const Sequence &sequence, std::uint64_t seed) : _sequence(sequence), _random(seed) {}

    void Hears(std::span<const std::uint8_t> datagram, TimePoint now) { _heard.Take(datagram, now); }
    const Hearing &Heard() const { return _heard; }
    std::vector<Sent> Next(TimePoint now)
    {
        Turn turn{_number++, now, _heard, _random};
        _sequence.Play(turn);
        return std::move(turn.Out);
    }

private:
    const Sequence &_sequence;
    std::mt19937_64 _random;
    Hearing _heard;
    std::uint64_t _number = 0;
};

}  // namespace Opponent
