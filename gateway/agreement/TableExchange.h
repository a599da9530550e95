#pragma once

#include <rabit/base/Backoff.h>

#include <algorithm>
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
// summary of its table, and the answer is all entries that differ or that the summary lacks. So a beat brings
// the receiver all that the beat's sender knows, and a beat of each of the two makes both tables equal.
// Nothing goes where no beat is heard.
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
    // Summaries that come faster from one peer, and copies, are not answered: each may cost a whole table.
    static constexpr Duration BetweenAnswers = std::chrono::milliseconds(200);
    // Datagrams that wait to be sent. Others are dropped: a later beat begins anew.
    static constexpr std::size_t MostWaiting = 64;

    struct Datagram
    {
        std::string To;
        std::vector<std::uint8_t> Bytes;
    };

    // The table must outlive the object. Peers are remembered until ForgetUnless, so the caller bounds them.
    explicit TableExchange(TableCopy &table) : _table(table) {}

    // A beat of another node has come, with the digest of its table.
    void OnDigest(std::string_view from, std::uint64_t digest, Duration now);
    // Takes a datagram of another node, of any bytes.
    void OnDatagram(std::string_view from, std::span<const std::uint8_t> bytes, Duration now);
    // Forgets all peers but those for which isHeard(name) is true. The intervals of a forgotten one are the
    // first ones once it is heard again.
    template <typename IsHeard>
    void ForgetUnless(const IsHeard &isHeard)
    {
        std::erase_if(_peers, [&isHeard](const auto &peer) { return !isHeard(peer.first); });
    }

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

private:
    struct Peer
    {
        std::optional<std::pair<std::uint64_t, std::uint64_t>> Digests{};  // own, and of the peer
        BackoffTimer<Duration> Ask;
        std::optional<Duration> AskedAt{};
        std::optional<Duration> AnsweredAt{};
    };

    Peer &PeerOf(std::string_view name);
    void Answer(std::string_view from, const TableSummary &summary, Duration now);
    void Send(std::string_view to, std::vector<std::uint8_t> bytes);

    TableCopy &_table;
    std::map<std::string, Peer, std::less<>> _peers;
    std::deque<Datagram> _waiting;
    std::uint32_t _salt = 0;
    std::uint64_t _malformed = 0;
};

}  // namespace Rabit
