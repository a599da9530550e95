#include "agreement/TableExchange.h"

#include <algorithm>
#include <iterator>

namespace Rabit
{

void TableExchange::OnDigest(std::string_view from, std::uint64_t digest, Duration now)
{
    Peer &peer = PeerOf(from, now);
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
    for (const TableSummary &part : TableSummariesOf(_table.Summary(), _table.Room()))
    {
        Send(from, EncodeTableSummary(part));
    }
}

void TableExchange::OnDatagram(std::string_view from, std::span<const std::uint8_t> bytes, Duration now)
{
    if (const auto summary = DecodeTableSummary(bytes))
    {
        Answer(from, *summary, now);
    }
    else if (const auto request = DecodeTableRequest(bytes))
    {
        Answer(from, *request, now);
    }
    else if (const auto entries = DecodeTableEntries(bytes))
    {
        Take(from, *entries);
    }
    else
    {
        ++_malformed;
    }
}

void TableExchange::Forget(std::string_view peer)
{
    const auto known = _peers.find(peer);
    if (known != _peers.end())
    {
        _peers.erase(known);
    }
}

TableExchange::Peer &TableExchange::PeerOf(std::string_view name, Duration now)
{
    auto known = _peers.find(name);
    if (known == _peers.end())
    {
        if (_peers.size() >= MostPeers)
        {
            _peers.erase(std::min_element(_peers.begin(), _peers.end(),
                                          [](const auto &one, const auto &other)
                                          { return one.second.HeardAt < other.second.HeardAt; }));
        }
        Peer peer{.Ask = BackoffTimer<Duration>(Intervals)};
        known = _peers.emplace(std::string(name), std::move(peer)).first;
    }
    known->second.HeardAt = now;
    return known->second;
}

void TableExchange::Answer(std::string_view from, const TableSummary &summary, Duration now)
{
    std::optional<Duration> &answeredAt = PeerOf(from, now).AnsweredAt[summary.Part];
    if (answeredAt && now - *answeredAt < BetweenAnswers)
    {
        ++_unanswered;
        return;
    }
    answeredAt = now;
    SendEntries(from, UnknownTo(summary));
    std::vector<std::uint64_t> unknown;
    for (const auto &[key, entries] : summary.Pairs)
    {
        if (!_table.Summary().contains(key))
        {
            unknown.push_back(key);
        }
    }
    std::span<const std::uint64_t> wanted(unknown);
    wanted = wanted.first(std::min(wanted.size(), _table.Room()));
    _table.RefuseUnasked(unknown.size() - wanted.size());
    while (!wanted.empty())
    {
        const auto keys = wanted.first(std::min(wanted.size(), TableRequest::MostKeys));
        wanted = wanted.subspan(keys.size());
        Send(from, EncodeTableRequest({.Keys = {keys.begin(), keys.end()}}));
    }
}

std::vector<TableEntry> TableExchange::UnknownTo(const TableSummary &summary) const
{
    std::vector<TableEntry> unknown;
    std::size_t room = summary.Room;
    const TableCopy::Pairs &own = _table.Summary();
    for (auto pair = own.lower_bound(summary.First); pair != own.end() && pair->first <= summary.Last; ++pair)
    {
        const auto theirs = summary.Pairs.find(pair->first);
        const bool isNew = theirs == summary.Pairs.end();
        if (isNew ? room > 0 : theirs->second != pair->second)
        {
            room -= isNew ? 1U : 0U;
            std::vector<TableEntry> entries = _table.EntriesOf(pair->first);
            std::move(entries.begin(), entries.end(), std::back_inserter(unknown));
        }
    }
    return unknown;
}

void TableExchange::Answer(std::string_view from, const TableRequest &request, Duration now)
{
    Peer &peer = PeerOf(from, now);
    if (!peer.RequestedAt || now - *peer.RequestedAt >= BetweenAnswers)
    {
        peer.RequestedAt = now;
        peer.Requested = 0;
    }
    if (request.Keys.size() > TableCopy::MostKeys - peer.Requested)
    {
        _unanswered += request.Keys.size();
        return;
    }
    peer.Requested += request.Keys.size();
    std::vector<TableEntry> wanted;
    for (const std::uint64_t key : request.Keys)
    {
        std::vector<TableEntry> entries = _table.EntriesOf(key);
        std::move(entries.begin(), entries.end(), std::back_inserter(wanted));
    }
    SendEntries(from, wanted);
}

void TableExchange::Take(std::string_view from, const std::vector<TableEntry> &entries)
{
    std::vector<TableEntry> newer;
    for (const TableEntry &entry : entries)
    {
        _table.Meet(entry);
        const TableValue *value = _table.Find(entry.Key);
        if (value != nullptr && *value != entry.Value)
        {
            newer.push_back({.Key = entry.Key, .Value = *value});
        }
    }
    SendEntries(from, newer);
}

void TableExchange::SendEntries(std::string_view to, const std::vector<TableEntry> &entries)
{
    for (std::vector<std::uint8_t> &bytes : EncodeTableEntries(entries))
    {
        Send(to, std::move(bytes));
    }
}

void TableExchange::Send(std::string_view to, std::vector<std::uint8_t> bytes)
{
    if (_waiting.size() >= MostWaiting)
    {
        ++_dropped;
        return;
    }
    _waiting.push_back({std::string(to), std::move(bytes)});
}

}  // namespace Rabit
