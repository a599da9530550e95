// The plaintext of a datagram of the kind Claim: a node says by which RTPS headers it speaks in its session,
// and proves that it is live to those whose nonces it repeats.
//
//   offset  size  what
//   0       1     format, 1
//   1       1     h, the number of RTPS headers, 1 to 4
//   2       1     a, the number of answers, up to 64
//   3       8     the sender's own nonce, to be answered; zero: it asks for no answer
//   11      20 h  RTPS headers: the first two bits of each datagram's outer header name one
//   ...     8 a   nonces of others that this claim answers
//   ...     1     c, the size of the certificate; 0: the receiver knows it by its hash
//   ...     c     the certificate
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "envelope/Types.h"

namespace Rabit::Envelope
{

struct Claim
{
    static constexpr std::size_t MostHeaders = 4;
    static constexpr std::size_t MostAnswers = 64;
    static constexpr std::size_t FixedSize = 11;  // in front of the RTPS headers
    // Bytes of a claim with so many headers and answers, and a certificate of that size.
    static constexpr std::size_t SizeWith(std::size_t headers, std::size_t answers, std::size_t certificate)
    {
        return FixedSize + headers * sizeof(RtpsHeader) + answers * sizeof(Nonce) + 1 + certificate;
    }

    Nonce Challenge{};
    std::vector<RtpsHeader> Headers{};
    std::vector<Nonce> Answers{};
    std::span<const std::uint8_t> Certificate{};  // borrowed; empty: the receiver knows it
};

// Accepts any bytes. Empty if they are no claim, or if a header is none of RTPS 2 with a sender.
std::optional<Claim> ReadClaim(std::span<const std::uint8_t> bytes);
// The claim must have as many headers, answers and bytes of a certificate as one may have.
std::vector<std::uint8_t> WriteClaim(const Claim &claim);

}  // namespace Rabit::Envelope
