#include "agreement/TableExchange.h"

#include <algorithm>

namespace Rabit
{

static_assert(TableSummary::MostHashes == TableCopy::MostKeys);

void TableExchange::OnDigest(std::string_view from, std::uint64_t digest, Duration now)
{
    Peer &peer = PeerOf(from);
    const std::pair digests(_table.Digest(), digest);
    if (peer.Digests != digests)
    {
        peer.Digests = digests;
        peer.Ask.Begin(peer.AskedAt ? std::max(now, *peer.AskedAt + Intervals.First) : now);
    }
    if (_table.Digest() == digest || !peer.Ask.IsDue(now))
    {
        return;
    }
    peer.Ask.Done(now);
    peer.AskedAt = now;
    ++_salt;
    Send(from, EncodeTableSummary({.Salt = _salt, .Hashes = _table.Hashes(_salt)}));
}

void TableExchange::OnDatagram(std::string_view from, std::span<const std::uint8_t> bytes, Duration now)
{
    if (const auto summary = DecodeTableSummary(bytes))
    {
        Answer(from, *summary, now);
    }
    else if (const auto entries = DecodeTableEntries(bytes))
    {
        for (const TableEntry &entry : *entries)
        {
            _table.Meet(entry);
        }
    }
    else
    {
        ++_malformed;
    }
}

TableExchange::Peer &TableExchange::PeerOf(std::string_view name)
{
    return _peers.try_emplace(std::string(name), Peer{.Ask = BackoffTimer<Duration>(Intervals)})
        .first->second;
}

void TableExchange::Answer(std::string_view from, const TableSummary &summary, Duration now)
{
    std::optional<Duration> &answeredAt = PeerOf(from).AnsweredAt;
    if (answeredAt && now - *answeredAt < BetweenAnswers)
    {
        return;
    }
    answeredAt = now;
    for (std::vector<std::uint8_t> &bytes :
         EncodeTableEntries(_table.EntriesBeside(summary.Hashes, summary.Salt)))
    {
        Send(from, std::move(bytes));
    }
}

void TableExchange::Send(std::string_view to, std::vector<std::uint8_t> bytes)
{
    if (_waiting.size() < MostWaiting)
    {
        _waiting.push_back({std::string(to), std::move(bytes)});
    }
}

}  // namespace Rabit
