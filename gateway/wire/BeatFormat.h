#pragma once

#include <rabit/transport/Transport.h>

#include <cstddef>
#include <cstdint>

// Beats as they are on the wire. They go by the hundred thousand, so each byte counts.
namespace Rabit::BeatFormat
{

// Changes whenever a gateway of another version could not make sense of a beat. Never below 256: the beats of
// the first gateways began with the length of a node's name.
inline constexpr std::uint16_t Present = 0xbe03;

// Bytes of bodies (CDR without the encapsulation).
inline constexpr std::size_t Empty = 20;
// With news, none of which says anything yet.
inline constexpr std::size_t WithNews = 40;
inline constexpr std::size_t State = 4;
inline constexpr std::size_t Echo = 12;
inline constexpr std::size_t Delay = 8;
inline constexpr std::size_t PartHeader = 8;
constexpr std::size_t Wanted(std::size_t bytesOfStates)
{
    return 12 + (bytesOfStates + 3) / 4 * 4;
}
// What this node's beats take at most: one datagram, whatever the settings are.
inline constexpr std::size_t Largest = 900;

// What is put into one beat at most; the rest follows in the next ones.
inline constexpr std::size_t MostStates = 64;
inline constexpr std::size_t MostWants = 8;
inline constexpr std::size_t MostEchoes = 2;  // and as many as there is room for while peers doubt this node
inline constexpr std::size_t MostDelays = 16;

// What tools and replays say that they are (wire/BeatExtensions.h).
inline constexpr std::size_t ToolMark = Wanted(0);
inline constexpr std::size_t ReplayMark = Wanted(0);

// A question for a type.
inline constexpr std::size_t TypeQuestion = Wanted(16);
inline constexpr std::size_t MostTypeQuestions = 4;

// Wanted::offers: the announcement is not lacking.
inline constexpr std::uint16_t NotLacking = 0xffff;

// Whether a sample begins as beats of this format do.
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
