// The datagrams of a shared table. The first byte tells them from those of claims. Numbers are little-endian.
//
//   summary: 3, salt (4), count (2), hashes of entries (4)
//   entries: 4, count (1), entries (TableEntry.h)
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "agreement/TableEntry.h"

namespace Rabit
{

// The entries that a node has, as a salted hash of each (TableCopy::Hashes). It asks for all others.
struct TableSummary
{
    static constexpr std::size_t MostHashes = 256;

    std::uint32_t Salt = 0;
    std::vector<std::uint32_t> Hashes{};
    bool operator==(const TableSummary &) const = default;
};

// There must be at most MostHashes hashes. The datagram has at most 1,031 bytes.
std::vector<std::uint8_t> EncodeTableSummary(const TableSummary &summary);
// Returns as many datagrams as it takes, each of at most 1,200 bytes.
std::vector<std::vector<std::uint8_t>> EncodeTableEntries(std::span<const TableEntry> entries);

// Accept any bytes; empty if they are none, or exceed a bound.
std::optional<TableSummary> DecodeTableSummary(std::span<const std::uint8_t> bytes);
std::optional<std::vector<TableEntry>> DecodeTableEntries(std::span<const std::uint8_t> bytes);

}  // namespace Rabit
