#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace Rabit
{

// The peers' reports of the delay of this node's datagrams, and their agreement. The lower median of the
// peers counts, so one late datagram, or one peer that is busy or lies, is no agreement.
//
// Bounded: the 64 peers heard last, 8 reports of each, none older than 15 s. Pure; `now` never goes back.
class DelayReports
{
public:
    using Duration = std::chrono::nanoseconds;
    using Peer = std::uint32_t;

    static constexpr std::size_t MostPeers = 64;
    static constexpr std::size_t MostReports = 8;
    static constexpr Duration Fresh = std::chrono::seconds(5);
    // Older reports go: what was sent between them is not known any more (SentHistory).
    static constexpr Duration Oldest = std::chrono::seconds(15);
    static constexpr Duration LongEnough = std::chrono::milliseconds(600);

    struct Report
    {
        Duration CameAt{0};     // when the report came here
        Duration ArrivedAt{0};  // when the reported datagram arrived there
        Duration Delay{0};      // of that datagram

        Duration SentAt() const { return ArrivedAt - Delay; }
    };

    // Reports of one peer, the newest last.
    using Reports = std::vector<Report>;

    void Add(Peer peer, Duration delay, Duration arrivedAt, Duration now);

    void Clear() { _peers.clear(); }

    // The lower median of the newest reports of the peers that have reported lately; empty: none has.
    std::optional<Duration> Latest(Duration now) const;
    // True if the peers agree that datagrams come later than `later`. Either more than half of them say so in
    // their last two reports. With four peers or more the last report is enough, and one peer alone needs its
    // last three. Or one peer says so in three reports over LongEnough, and no report of another peer about a
    // datagram as new contradicts.
    bool Agree(Duration later, Duration now) const;
    // The lower median of f(reports) over the peers that have reported lately, empty results left out.
    template <typename Function>
    auto MedianOf(const Function &f, Duration now) const -> decltype(f(std::declval<const Reports &>()));
    // The reports of one peer, the newest last; nullptr: none.
    const Reports *Of(Peer peer) const;

private:
    struct Entry
    {
        Peer Who = 0;
        Reports Said;
    };

    static bool IsFresh(const Entry &entry, Duration now);
    static Reports::const_iterator FirstLate(const Reports &said, Duration later);
    bool IsContradicted(const Entry &entry, const Report &first, Duration later, Duration now) const;

    std::vector<Entry> _peers;
};

template <typename Function>
auto DelayReports::MedianOf(const Function &f, Duration now) const
    -> decltype(f(std::declval<const Reports &>()))
{
    std::vector<typename decltype(f(std::declval<const Reports &>()))::value_type> values;
    for (const Entry &entry : _peers)
    {
        if (IsFresh(entry, now))
        {
            if (const auto value = f(entry.Said))
            {
                values.push_back(*value);
            }
        }
    }
    if (values.empty())
    {
        return std::nullopt;
    }
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

}  // namespace Rabit
