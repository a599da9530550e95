// The datagrams of a shared table. The first byte tells them from those of claims. Numbers are little-endian.
//
//   summary: 3, part (1), room (2), first key hash (8), last key hash (8), count (1),
//            pairs of key hash (8) and hash of its entries (8)
//   request: 4, count (1), key hashes (8)
//   entries: 5, count (1), entries (TableEntry.h)
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "agreement/TableEntry.h"

namespace Rabit
{

// One part of what a node knows: all of its keys whose hash is from First to Last, both included.
struct TableSummary
{
    static constexpr std::size_t MostPairs = 64;
    static constexpr std::size_t MostParts = 4;

    std::uint8_t Part = 0;
    std::uint16_t Room = 0;  // how many more keys the sender can take
    std::uint64_t First = 0;
    std::uint64_t Last = std::numeric_limits<std::uint64_t>::max();
    std::map<std::uint64_t, std::uint64_t> Pairs{};
    bool operator==(const TableSummary &) const = default;
};

// Key hashes whose entries are wanted.
struct TableRequest
{
    static constexpr std::size_t MostKeys = 16;

    std::vector<std::uint64_t> Keys{};
    bool operator==(const TableRequest &) const = default;
};

// Returns the parts, which have all pairs and the whole range of hashes. At least one.
std::vector<TableSummary> TableSummariesOf(const std::map<std::uint64_t, std::uint64_t> &pairs,
                                           std::size_t room);

// Numbers of pairs, keys and parts must be within their bounds.
std::vector<std::uint8_t> EncodeTableSummary(const TableSummary &summary);
std::vector<std::uint8_t> EncodeTableRequest(const TableRequest &request);
// Returns as many datagrams as it takes, each of at most 1,200 bytes.
std::vector<std::vector<std::uint8_t>> EncodeTableEntries(std::span<const TableEntry> entries);

// Accept any bytes; empty if they are none, or exceed a bound.
std::optional<TableSummary> DecodeTableSummary(std::span<const std::uint8_t> bytes);
std::optional<TableRequest> DecodeTableRequest(std::span<const std::uint8_t> bytes);
std::optional<std::vector<TableEntry>> DecodeTableEntries(std::span<const std::uint8_t> bytes);

}  // namespace Rabit
