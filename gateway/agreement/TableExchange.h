#pragma once

#include <rabit/base/Backoff.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "agreement/TableCopy.h"
#include "agreement/TableMessages.h"

namespace Rabit
{

// Makes the tables of two nodes equal that hear each other.
//
// Each beat carries the digest of its sender's table. A node that hears another digest than its own sends a
// summary of its table. The answer is all entries that differ or that the sender does not have, and requests
// for the keys that only the sender has. A node that gets an entry and knows more sends that back. So either
// of the two may begin, and both have the same then. Nothing goes where no beat is heard.
//
// A pure state machine. Time is passed in: that of a steady clock. Not thread-safe.
class TableExchange
{
public:
    using Duration = std::chrono::nanoseconds;

    // Summaries to one peer: an interval is repeated four times, since datagrams are lost, and then doubled.
    // It is the first one again if either digest has changed.
    static constexpr Backoff::Settings Intervals = {.First = std::chrono::milliseconds(250),
                                                    .Longest = std::chrono::seconds(16),
                                                    .QuickSteps = 4,
                                                    .Quick = std::chrono::milliseconds(250)};
    // Copies of a summary's part, and parts that come faster from one peer, are not answered. A peer that
    // requests keys gets as many of them in that time as a table has, at most.
    static constexpr Duration BetweenAnswers = std::chrono::milliseconds(200);
    // Datagrams that wait to be sent. Others are dropped: a later beat begins anew.
    static constexpr std::size_t MostWaiting = 64;
    // If there are more, the one that was heard longest ago is forgotten.
    static constexpr std::size_t MostPeers = 1024;

    struct Datagram
    {
        std::string To;
        std::vector<std::uint8_t> Bytes;
    };

    // The table must outlive the object.
    explicit TableExchange(TableCopy &table) : _table(table) {}

    // A beat of another node has come, with the digest of its table.
    void OnDigest(std::string_view from, std::uint64_t digest, Duration now);
    // Takes a datagram of another node, of any bytes.
    void OnDatagram(std::string_view from, std::span<const std::uint8_t> bytes, Duration now);
    // The peer is LOST, or started again: its intervals are the first ones once it is heard.
    void Forget(std::string_view peer);

    // The first datagram that waits, and that mayGo(datagram) lets go; empty: there is none.
    template <typename MayGo>
    std::optional<Datagram> TakeDatagram(const MayGo &mayGo)
    {
        const auto found = std::find_if(_waiting.begin(), _waiting.end(), mayGo);
        if (found == _waiting.end())
        {
            return std::nullopt;
        }
        std::optional<Datagram> datagram(std::move(*found));
        _waiting.erase(found);
        return datagram;
    }
    bool IsWaiting() const { return !_waiting.empty(); }

    std::uint64_t Malformed() const { return _malformed; }
    // Datagrams that were not sent, since too many waited.
    std::uint64_t Dropped() const { return _dropped; }
    // Parts of summaries, and keys of requests, that were not answered, since they came too fast.
    std::uint64_t Unanswered() const { return _unanswered; }
    std::size_t Peers() const { return _peers.size(); }

private:
    struct Peer
    {
        std::optional<std::pair<std::uint64_t, std::uint64_t>> Digests{};  // own, and of the peer
        BackoffTimer<Duration> Ask;
        std::optional<Duration> AskedAt{};
        std::array<std::optional<Duration>, TableSummary::MostParts> AnsweredAt{};
        std::optional<Duration> RequestedAt{};  // first of the keys that Requested counts
        std::size_t Requested = 0;
        Duration HeardAt{0};
    };

    Peer &PeerOf(std::string_view name, Duration now);
    void Answer(std::string_view from, const TableSummary &summary, Duration now);
    // Entries that differ, and as many others as the sender of the summary can take.
    std::vector<TableEntry> UnknownTo(const TableSummary &summary) const;
    void Answer(std::string_view from, const TableRequest &request, Duration now);
    void Take(std::string_view from, const std::vector<TableEntry> &entries);
    void SendEntries(std::string_view to, const std::vector<TableEntry> &entries);
    void Send(std::string_view to, std::vector<std::uint8_t> bytes);

    TableCopy &_table;
    std::map<std::string, Peer, std::less<>> _peers;
    std::deque<Datagram> _waiting;
    std::uint64_t _malformed = 0;
    std::uint64_t _dropped = 0;
    std::uint64_t _unanswered = 0;
};

}  // namespace Rabit
