#include "agreement/TableMessages.h"

#include <rabit/base/LittleEndian.h>
#include <rabit/base/WireBytes.h>

#include <algorithm>
#include <utility>

namespace Rabit
{
namespace
{

constexpr std::uint8_t TableSummaryByte = 3;
constexpr std::uint8_t TableEntriesByte = 4;
constexpr std::size_t LongestEntriesDatagram = 1200;
constexpr std::uint8_t MostEntriesOfADatagram = 255;  // their number is a byte

}  // namespace

std::vector<std::uint8_t> EncodeTableSummary(const TableSummary &summary)
{
    std::vector<std::uint8_t> bytes{TableSummaryByte};
    LittleEndian::Put(summary.Salt, bytes);
    LittleEndian::Put(static_cast<std::uint16_t>(summary.Hashes.size()), bytes);
    for (const std::uint32_t hash : summary.Hashes)
    {
        LittleEndian::Put(hash, bytes);
    }
    return bytes;
}

std::vector<std::vector<std::uint8_t>> EncodeTableEntries(std::span<const TableEntry> entries)
{
    std::vector<std::vector<std::uint8_t>> datagrams;
    std::vector<std::uint8_t> one;
    for (const TableEntry &entry : entries)
    {
        one.clear();
        PutTableEntry(entry, one);
        if (datagrams.empty() || datagrams.back().size() + one.size() > LongestEntriesDatagram ||
            datagrams.back()[1] == MostEntriesOfADatagram)
        {
            datagrams.push_back({TableEntriesByte, std::uint8_t{0}});
        }
        std::vector<std::uint8_t> &datagram = datagrams.back();
        ++datagram[1];
        datagram.insert(datagram.end(), one.begin(), one.end());
    }
    return datagrams;
}

std::optional<TableSummary> DecodeTableSummary(std::span<const std::uint8_t> bytes)
{
    WireReader from(bytes);
    if (from.Byte() != TableSummaryByte)
    {
        return std::nullopt;
    }
    TableSummary summary{.Salt = from.Fixed<std::uint32_t>()};
    const std::size_t count = from.Fixed<std::uint16_t>();
    summary.Hashes.resize(std::min(count, TableSummary::MostHashes));
    for (std::uint32_t &hash : summary.Hashes)
    {
        hash = from.Fixed<std::uint32_t>();
    }
    const bool isWhole = from.IsAtEnd() && summary.Hashes.size() == count;
    return isWhole ? std::optional(std::move(summary)) : std::nullopt;
}

std::optional<std::vector<TableEntry>> DecodeTableEntries(std::span<const std::uint8_t> bytes)
{
    WireReader from(bytes);
    if (from.Byte() != TableEntriesByte)
    {
        return std::nullopt;
    }
    std::vector<TableEntry> entries(from.Byte());
    for (TableEntry &entry : entries)
    {
        entry = TakeTableEntry(from);
    }
    return from.IsAtEnd() ? std::optional(std::move(entries)) : std::nullopt;
}

}  // namespace Rabit
