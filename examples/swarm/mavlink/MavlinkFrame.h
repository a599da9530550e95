#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace Swarm
{

// One packet of MAVLink, the protocol of small autopilots (https://mavlink.io/en/guide/serialization.html).
struct MavlinkFrame
{
    enum class Version
    {
        One,  // starts with 0xFE; message numbers up to 255
        Two   // starts with 0xFD; zeros at the payload's end are not sent
    };
    static constexpr std::size_t LargestPayload = 255;

    Version Protocol = Version::Two;
    std::uint8_t Sequence = 0;
    std::uint8_t System = 1;     // who sends: the aircraft ...
    std::uint8_t Component = 1;  // ... and which part of it
    std::uint32_t Message = 0;   // number of the message type, 24 bits
    std::vector<std::uint8_t> Payload;
};

// The byte that the definition of a message type adds to the checksum, so that programs with different
// definitions do not misread each other. Empty for types that this program does not know.
std::optional<std::uint8_t> MavlinkExtraOf(std::uint32_t message);

// The checksum: CRC-16/MCRF4XX, like X.25 but without the final inversion.
std::uint16_t MavlinkChecksum(std::span<const std::uint8_t> bytes, std::uint16_t before = 0xFFFF);

// The bytes of a frame, unsigned. Throws std::invalid_argument if the message type is not known, the payload
// is too long, or the number does not fit version 1.
std::vector<std::uint8_t> EncodeMavlink(const MavlinkFrame &frame);

// Finds the frames in a stream of bytes, or in datagrams. Bytes with a wrong checksum are skipped and
// counted. The search goes on at the byte after the start byte, so that a frame inside noise is not lost.
// Signatures of version 2 are skipped, not checked. Not thread-safe.
class MavlinkParser
{
public:
    struct Counters
    {
        std::uint64_t Frames = 0;       // returned by Next
        std::uint64_t BadChecksum = 0;  // looked like a known message, but failed the checksum
        std::uint64_t Unknown = 0;  // frames of a type, or with a feature, that this program does not know
        std::uint64_t Skipped = 0;  // bytes that belonged to no frame
    };

    // Adds bytes of the stream.
    void Add(std::span<const std::uint8_t> bytes);
    // The next complete frame; empty if more bytes are needed. A payload of version 2 is not padded to full
    // length.
    std::optional<MavlinkFrame> Next();

    const Counters &Count() const { return _counters; }

private:
    enum class Result
    {
        Frame,
        Unknown,
        Incomplete,
        NotHere
    };
    Result TryAt(std::size_t start, MavlinkFrame &frame, std::size_t &length);

    std::vector<std::uint8_t> _bytes;
    std::size_t _begin = 0;  // start of the unused bytes
    Counters _counters;
};

}  // namespace Swarm
