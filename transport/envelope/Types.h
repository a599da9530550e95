// Names of the values that the stages of the envelope pass to each other.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "common/Rtps.h"

namespace Rabit::Envelope
{

using TimePoint = std::chrono::steady_clock::time_point;
// Random bytes: one opening of one node on one path.
using SessionId = std::array<std::uint8_t, 16>;
constexpr SessionId AllSessions{};  // the receiver of a datagram for all
// SHA-256 (FIPS 180-4).
using Hash = std::array<std::uint8_t, 32>;
// An Ed25519 (RFC 8032) or X25519 (RFC 7748) public key.
using PublicKey = std::array<std::uint8_t, 32>;
using Signature = std::array<std::uint8_t, 64>;
// Random bytes that a receiver makes and a sender repeats under its signature (SessionTable.h).
using Nonce = std::array<std::uint8_t, 8>;
// Names a session in each of its datagrams: KeyDerivation.h.
using SessionTag = std::uint32_t;
// Counts the sets of keys of a fleet, from 1. The authority raises it (Bulletin.h).
using Epoch = std::uint16_t;
// No fleet gets there. Anybody may send a datagram that names it, to learn whether nodes with keys are there:
// each answers by a claim that asks nobody (SealedCore).
constexpr Epoch EpochOfCalls = std::numeric_limits<Epoch>::max();
// Of a certificate; the authority gives each serial once.
using Serial = std::uint32_t;
using RtpsHeader = std::array<std::uint8_t, Rtps::RtpsHeaderSize>;

constexpr std::size_t TagSize = 16;  // of ChaCha20-Poly1305 (RFC 8439)

}  // namespace Rabit::Envelope
