#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "backfill/RangeSet.h"
#include "backfill/Series.h"

namespace Rabit::Backfill
{

// Which posts of other nodes are in this node's recording, and which ranges are known to be whole. So each
// post is written once, whether it came live or later. Thread-safe.
class Ledger
{
public:
    // Stamps of one series that are remembered outside of whole ranges. Beyond them the oldest are taken for
    // the beginning of the series, so what came before is no longer requested.
    static constexpr std::size_t MostStamps = 65536;
    // Series that are remembered; posts of further ones are recorded as they come, and not requested.
    static constexpr std::size_t MostSeries = 4096;

    // Forgets all.
    void Clear();
    // True if this post is to be recorded: it was not there yet. From now on it is.
    bool Take(const Series &series, Stamp stamp);
    // It could not be recorded after all.
    void Undo(const Series &series, Stamp stamp);
    // All posts of this range that the origin recorded are here.
    void SetWhole(const Series &series, Range range);
    // The origin has posts with these stamps.
    void SetSpan(const Series &series, Range stamps);

    struct Gap
    {
        Series Of;
        Range Stamps;
        std::vector<Stamp> Had;  // within it
        bool IsNewest = false;   // it ends with the newest post that is known: perhaps nothing is missing
    };
    // Stamps in Gap::Had. A longer gap is returned from its end.
    static constexpr std::size_t MostHad = 512;
    // Returns the newest gap of that message; empty: none. The gap that IsNewest, which is one of the node's
    // present incarnation, is left out if `!andNewest`. The present incarnation comes first: its number may
    // be lower than former ones, after the node's clock was put back.
    std::optional<Gap> NewestGap(const std::string &node, const std::string &message, std::uint64_t present,
                                 bool andNewest) const;

    // Number of stamps kept, of all series.
    std::size_t Stamps() const;

private:
    struct Track
    {
        RangeSet Whole;
        std::set<Stamp> Had;        // outside of it
        std::optional<Range> Span;  // of posts that are known of; empty: the origin was not asked yet
        Stamp Floor = 0;            // what is below is not requested
    };

    Track *FindOrAdd(const Series &series);
    static Gap GapOf(const Series &series, const Track &track, Range gap);
    static std::optional<Gap> NewestGapOf(const Series &series, const Track &track, bool isPresent,
                                          bool andNewest);

    mutable std::mutex _mutex;
    std::map<Series, Track> _tracks;
};

}  // namespace Rabit::Backfill
