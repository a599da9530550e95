// Writes RTPS messages (OMG DDSI-RTPS 2.3, 9.4).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/Rtps.h"

namespace Rabit::Rtps
{

// Writes a number over bytes.
void Write(std::span<std::uint8_t> bytes, std::uint64_t number, bool littleEndian);
// Writes a sequence number over the first eight bytes: the high half comes first (9.3.2).
void WriteSequence(std::span<std::uint8_t> bytes, std::int64_t number, bool littleEndian);

// These append to a little-endian message: the number in `size` bytes, bytes, an entity, a sequence number.
void Append(std::vector<std::uint8_t> &message, std::uint64_t number, std::size_t size);
void Append(std::vector<std::uint8_t> &message, std::span<const std::uint8_t> bytes);
void AppendEntity(std::vector<std::uint8_t> &message, EntityId entity);
void AppendSequence(std::vector<std::uint8_t> &message, std::int64_t number);
// `length`: of the submessage's body.
void AppendSubmessageHeader(std::vector<std::uint8_t> &message, SubmessageKind kind, std::size_t length,
                            std::uint8_t flags = 0);
// A parameter of a list (9.4.2.11).
void AppendParameter(std::vector<std::uint8_t> &message, std::uint16_t id,
                     std::span<const std::uint8_t> value);
// Addresses the submessages that follow to one participant; zero: to all.
void AppendDestination(std::vector<std::uint8_t> &message, const GuidPrefix &to);

}  // namespace Rabit::Rtps
