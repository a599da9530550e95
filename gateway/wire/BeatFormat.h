#pragma once

#include <rabit/transport/Transport.h>

#include <cstddef>
#include <cstdint>

// The format of beats on the wire. Beats are sent by the hundred thousand, so each byte counts.
namespace Rabit::BeatFormat
{

// Changes whenever gateways of other versions could not understand a beat. Never below 256: the beats of the
// first gateways began with the length of a node's name.
inline constexpr std::uint16_t Present = 0xbe03;

// Bytes of bodies (CDR without the encapsulation).
inline constexpr std::size_t Empty = 20;
// A beat with empty news.
inline constexpr std::size_t WithNews = 40;
inline constexpr std::size_t State = 4;
inline constexpr std::size_t Echo = 12;
inline constexpr std::size_t Delay = 8;
inline constexpr std::size_t PartHeader = 8;
constexpr std::size_t Wanted(std::size_t bytesOfStates)
{
    return 12 + (bytesOfStates + 3) / 4 * 4;
}
// Largest beat that this node sends: one datagram, whatever the settings are.
inline constexpr std::size_t Largest = 900;

// Most entries in one beat; the rest follows in the next ones.
inline constexpr std::size_t MostStates = 64;
inline constexpr std::size_t MostWants = 8;
inline constexpr std::size_t MostEchoes = 2;  // and as many as there is room for while peers doubt this node
// Each node needs some reports a second, and the peers take turns.
inline constexpr std::size_t MostDelays = 4;
// True if a beat with so many reports of delays tells that no datagram of the other nodes is late. A full
// list tells nothing of them: their turn may come with the next beat.
constexpr bool TellsOfAllDelays(std::size_t reports)
{
    return reports < MostDelays;
}

// The marks of tools and replays (wire/BeatExtensions.h).
inline constexpr std::size_t ToolMark = Wanted(0);
inline constexpr std::size_t ReplayMark = Wanted(0);

// A ProblemCount.
inline constexpr std::size_t Problems = Wanted(6);

// A FleetSum.
inline constexpr std::size_t FleetSum = Wanted(4);

// The mark that `nodes` nodes are heard by this path and no better one.
constexpr std::size_t FirstHeard(std::size_t nodes)
{
    return nodes == 0 ? 0 : Wanted(4 * nodes);
}

// An AgreementNews with so many bytes of its renewal and of its answers. An extension has 52 bytes of
// answers.
constexpr std::size_t Agreement(std::size_t renewal, std::size_t answers)
{
    return Wanted(12 + renewal) + answers / 52 * Wanted(52) + (answers % 52 == 0 ? 0 : Wanted(answers % 52));
}

// A question for a type.
inline constexpr std::size_t TypeQuestion = Wanted(16);
inline constexpr std::size_t MostTypeQuestions = 4;

// Wanted::offers: the announcement is not lacking.
inline constexpr std::uint16_t NotLacking = 0xffff;

// True if a sample begins like a beat of this format.
inline bool IsPresent(SampleBytes bytes)
{
    if (bytes.size() < 6)
    {
        return false;
    }
    const bool littleEndian = (bytes[1] & 1) != 0;
    const unsigned low = bytes[littleEndian ? 4 : 5];
    const unsigned high = bytes[littleEndian ? 5 : 4];
    return (high << 8 | low) == Present;
}

}  // namespace Rabit::BeatFormat
