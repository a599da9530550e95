// The header in front of each sealed datagram. Numbers are little-endian:
//
//   offset  size  what
//   0       1     bits 7-6: 10, which neither RTPS ("R") nor a zero byte begins with; bits 5-4: OuterKind;
//                 bits 3-2: OuterClass; bits 1-0: which of the session's RTPS headers was left out
//   1       2     epoch, from 1
//   3       4     session tag (KeyDerivation.h)
//   7       4     the low 32 bits of the datagram's number
//
// All of it is authenticated, and more that does not travel: OuterContext.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "envelope/KeyDerivation.h"
#include "envelope/Types.h"

namespace Rabit::Envelope
{

enum class OuterKind : std::uint8_t
{
    Group = 0,  // signed, for all
    // 1 is reserved: a signed datagram that only names its receiver could be repeated to another one
    Pairwise = 2,  // for one session, not signed: the key belongs to these two
    Claim = 3      // signed, for all; introduces its session (Claim.h)
};

enum class OuterClass : std::uint8_t
{
    Traffic = 0,  // taken only from a session that has shown that it is live
    Meeting = 1,  // claims, and cards: these are taken as traffic is. Must reach no parser of a vendor
    // Parts of a bulletin and requests for them: taken from any session that has claimed, in former epochs,
    // too. Must reach no parser of a vendor
    Bulletin = 2
};

constexpr std::size_t OuterSize = 11;
// The identity of the sender, in the clear behind the header of a claim: its session (16), the hash of its
// certificate (32), and the high 32 bits of the number (4).
constexpr std::size_t IntroductionSize = 52;
// Of UDP over IPv4, and so of a datagram, sealed or not.
constexpr std::size_t LargestDatagram = 65507;

struct Outer
{
    OuterKind Kind = OuterKind::Group;
    OuterClass Class = OuterClass::Traffic;
    std::uint8_t Header = 0;  // 0 to 3
    Envelope::Epoch Epoch = 0;
    SessionTag Tag = 0;
    std::uint32_t Number = 0;
    bool operator==(const Outer &) const = default;

    bool IsSigned() const { return Kind != OuterKind::Pairwise; }
};

enum class OuterFault : std::uint8_t
{
    None,
    TooShort,      // for its kind
    TooLong,       // LargestDatagram
    NotSealed,     // other bits 7-6: a plain datagram, or another format
    UnknownKind,   // 1
    UnknownClass,  // 3
    WrongClass,    // a claim of another class than Meeting, or with a header that it cannot have yet
    NoEpoch        // 0
};

// Bytes that sealing adds behind the RTPS header's place, without that header: header, introduction, tag,
// signature.
std::size_t OuterOverhead(OuterKind kind);

// Reads the header. Accepts any bytes; `outer` has a meaning only without a fault.
OuterFault ReadOuter(std::span<const std::uint8_t> datagram, Outer &outer);
// Writes the header over the first 11 bytes (OuterSize).
void WriteOuter(const Outer &outer, std::span<std::uint8_t> to);

// The content of the introduction behind a claim's header; `datagram` must have passed ReadOuter.
End ReadIntroduction(std::span<const std::uint8_t> datagram, std::uint32_t &high);
// Writes the introduction over the first 52 bytes (IntroductionSize).
void WriteIntroduction(const End &sender, std::uint32_t high, std::span<std::uint8_t> to);

// The context: the AEAD authenticates it, and a signature covers it in front of the plaintext.
//
//   0       16    "Rabit envelope 1"
//   16      11    the header
//   27      4     the high 32 bits of the number
//   31      16    the sender's session
//   47      32    the hash of the sender's certificate
//   79      16    the receiver's session; zero: for all
//   95      20    the RTPS header that was left out; zero in a claim
constexpr std::size_t OuterContextSize = 115;
constexpr std::size_t RtpsHeaderInContext = 95;
// Writes the context over the first 115 bytes. The bytes of the outer header are those that travel.
void WriteOuterContext(std::span<const std::uint8_t> outer, std::uint64_t number, const End &sender,
                       const SessionId &receiver, const RtpsHeader &left, std::span<std::uint8_t> to);

}  // namespace Rabit::Envelope
