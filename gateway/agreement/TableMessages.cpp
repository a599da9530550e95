#include "agreement/TableMessages.h"

#include <rabit/base/LittleEndian.h>

#include <utility>

#include "agreement/AgreementBytes.h"

namespace Rabit
{
namespace
{

constexpr std::uint8_t TableSummaryByte = 3;
constexpr std::uint8_t TableRequestByte = 4;
constexpr std::uint8_t TableEntriesByte = 5;
constexpr std::size_t LongestEntriesDatagram = 1200;
constexpr std::uint8_t MostEntriesOfADatagram = 255;

}  // namespace

std::vector<TableSummary> TableSummariesOf(const std::map<std::uint64_t, std::uint64_t> &pairs,
                                           std::size_t room)
{
    std::vector<TableSummary> parts(1);
    parts.front().Room = static_cast<std::uint16_t>(room);
    for (const auto &pair : pairs)
    {
        if (parts.back().Pairs.size() >= TableSummary::MostPairs)
        {
            TableSummary next;
            next.Part = static_cast<std::uint8_t>(parts.size());
            next.Room = parts.front().Room;
            next.First = pair.first;
            parts.back().Last = pair.first - 1;
            parts.push_back(std::move(next));
        }
        parts.back().Pairs.insert(pair);
    }
    return parts;
}

std::vector<std::uint8_t> EncodeTableSummary(const TableSummary &summary)
{
    using LittleEndian::Put;
    std::vector<std::uint8_t> bytes{TableSummaryByte, summary.Part};
    Put(summary.Room, bytes);
    Put(summary.First, bytes);
    Put(summary.Last, bytes);
    bytes.push_back(static_cast<std::uint8_t>(summary.Pairs.size()));
    for (const auto &[key, entries] : summary.Pairs)
    {
        Put(key, bytes);
        Put(entries, bytes);
    }
    return bytes;
}

std::vector<std::uint8_t> EncodeTableRequest(const TableRequest &request)
{
    std::vector<std::uint8_t> bytes{TableRequestByte, static_cast<std::uint8_t>(request.Keys.size())};
    for (const std::uint64_t key : request.Keys)
    {
        LittleEndian::Put(key, bytes);
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
    AgreementBytes from(bytes);
    if (from.Take<std::uint8_t>() != TableSummaryByte)
    {
        return std::nullopt;
    }
    TableSummary summary;
    summary.Part = static_cast<std::uint8_t>(from.Count(TableSummary::MostParts - 1));
    summary.Room = from.Take<std::uint16_t>();
    summary.First = from.Take<std::uint64_t>();
    summary.Last = from.Take<std::uint64_t>();
    for (std::size_t left = from.Count(TableSummary::MostPairs); left > 0; --left)
    {
        const auto key = from.Take<std::uint64_t>();
        summary.Pairs[key] = from.Take<std::uint64_t>();
    }
    return from.IsAtEnd() ? std::optional(std::move(summary)) : std::nullopt;
}

std::optional<TableRequest> DecodeTableRequest(std::span<const std::uint8_t> bytes)
{
    AgreementBytes from(bytes);
    if (from.Take<std::uint8_t>() != TableRequestByte)
    {
        return std::nullopt;
    }
    TableRequest request;
    request.Keys.resize(from.Count(TableRequest::MostKeys));
    for (std::uint64_t &key : request.Keys)
    {
        key = from.Take<std::uint64_t>();
    }
    return from.IsAtEnd() ? std::optional(std::move(request)) : std::nullopt;
}

std::optional<std::vector<TableEntry>> DecodeTableEntries(std::span<const std::uint8_t> bytes)
{
    AgreementBytes from(bytes);
    if (from.Take<std::uint8_t>() != TableEntriesByte)
    {
        return std::nullopt;
    }
    std::vector<TableEntry> entries(from.Count(MostEntriesOfADatagram));
    for (TableEntry &entry : entries)
    {
        entry = TakeTableEntry(from);
    }
    return from.IsAtEnd() ? std::optional(std::move(entries)) : std::nullopt;
}

}  // namespace Rabit
