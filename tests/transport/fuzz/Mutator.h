// Damages datagrams, at random and, where they are RTPS, where it hurts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <span>
#include <vector>

using Datagram = std::vector<std::uint8_t>;

// The same seed and datagrams give the same results.
class Mutator
{
public:
    explicit Mutator(std::uint64_t seed) : _random(seed) {}

    // Sets the datagrams to damage: at least one, each at least as long as an RTPS header.
    void Learn(const std::vector<Datagram> &datagrams);
    // Returns one of the datagrams, damaged in one to four ways.
    Datagram Next();

private:
    // Where a submessage begins and ends, as far as its lengths tell.
    struct Part
    {
        std::size_t Begin = 0;  // of the submessage's header
        std::size_t End = 0;
        bool LittleEndian = false;
    };

    std::size_t Below(std::size_t limit) { return limit == 0 ? 0 : _random() % limit; }
    bool OneIn(std::size_t n) { return Below(n) == 0; }
    std::uint32_t Number();

    static std::vector<Part> PartsOf(const Datagram &datagram);
    void Damage(Datagram &datagram);
    void DamageBytes(Datagram &datagram);
    void DamagePart(Datagram &datagram);
    void DamageNumbers(Datagram &datagram, const Part &part);
    void DamageParameters(Datagram &datagram, const Part &part);
    void DamageIdentity(Datagram &datagram);
    void SpeakForAnother(Datagram &datagram);
    void DamageSize(Datagram &datagram);
    void Splice(Datagram &datagram);
    void Put(Datagram &datagram, std::size_t at, std::size_t size, bool littleEndian, std::uint64_t value);

    std::mt19937_64 _random;
    std::vector<Datagram> _originals;
    std::vector<Datagram> _prefixes;
};
