#pragma once

#include <rabit/base/Backoff.h>
#include <rabit/gateway/RandomSource.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace Rabit
{

// Decides which States of other nodes to request. A State is written once, best effort; beats carry its
// version (StateVersion). A node with another version requests the State in its own beats, until it has it.
//
// - A node that is heard for the first time is asked at once. Otherwise the sample has AskAfter to arrive,
//   since beats may overtake it. Then it is requested again, each time after twice as long.
// - A sample that was lost at its origin is lacking at all nodes, which notice it by the same beat. The
//   answer to one goes to all; so they ask at random within a time that grows with their number.
// - A sample that is newer than the version in the beat is not lacking.
//
// A pure state machine: no I/O, no threads, no clock of its own; `now` never goes back. Bounded: MostNodes,
// and the States that this node wants of each.
class StateRepair
{
public:
    using Duration = std::chrono::nanoseconds;

    static constexpr Duration AskAfter = std::chrono::milliseconds(60);
    static constexpr Duration LongestWait = std::chrono::seconds(2);
    static constexpr Duration SpreadForOne = std::chrono::milliseconds(2);
    static constexpr Duration LongestSpread = std::chrono::milliseconds(100);
    // Further nodes are not asked.
    static constexpr std::size_t MostNodes = 1000;

    // A State of a node, by its index among those that it announces, and the subscription that wants it, by
    // an opaque number.
    struct Wanted
    {
        std::size_t State = 0;
        std::size_t Subscription = 0;

        bool operator==(const Wanted &) const = default;
    };

    // The source time of the newest sample of that incarnation of a node that a subscription has accepted;
    // empty: none.
    using TakenIn = std::function<std::optional<std::int64_t>(
        const std::string &node, std::uint64_t incarnation, std::size_t subscription)>;

    StateRepair(TakenIn takenIn, RandomSource random);

    // Sets the States wanted of an incarnation of a node, once its announcement is known. Replaces the former
    // ones.
    void SetWanted(const std::string &node, std::uint64_t incarnation, const std::vector<Wanted> &wanted);

    struct Told
    {
        std::uint64_t Incarnation = 0;
        // Versions of its States, by index; 0: never written, or not told yet.
        std::span<const std::uint32_t> Versions;
        // Estimate of the node's source clock now.
        std::int64_t SourceNow = 0;
        Duration RoundTrip{0};   // 0: unknown
        std::size_t Others = 0;  // nodes besides the two that may lack the same
    };

    // A beat of the node has carried versions.
    void OnTold(const std::string &node, const Told &told, Duration now);
    // The node is LOST: it is not asked until its beats tell versions again.
    void Rest(const std::string &node);
    void Forget(const std::string &node);

    struct Ask
    {
        std::string Node;
        std::vector<bool> States;  // to be requested from now on, by index; none: nothing any more
        bool Now = false;          // some are due: the next beat should come soon
    };

    // The nodes whose requests have changed or are due again. Checks which samples have arrived meanwhile; so
    // call it before each beat, and when it is Due.
    std::vector<Ask> Take(Duration now);
    // Empty: nothing is lacking.
    std::optional<Duration> Due() const;
    // True if nothing is lacking, and Take has no request to withdraw.
    bool IsIdle() const { return _due.empty() && _changed.empty(); }

private:
    struct Entry
    {
        Wanted What;
        bool Judged = false;      // compared at least once in this incarnation
        std::int64_t Stated = 0;  // the latest source time of the announced version
        // When it is requested (again); not due: it is there, or its node is LOST.
        BackoffTimer<Duration> Request{{2 * AskAfter, LongestWait}};
        bool Asked = false;  // in the beats
    };

    struct Node
    {
        std::uint64_t Incarnation = 0;
        std::vector<Entry> Entries;
        Duration RoundTrip{0};
        std::optional<Duration> Due;  // as in _due
        bool Changed = false;         // the request differs from the one that was taken
    };

    bool Has(const std::string &name, const Node &node, const Entry &entry) const;
    static void Settle(Node &node, Entry &entry);
    void LookAt(const std::string &name, Node &node, Entry &entry, std::size_t others, Duration now);
    bool Ripen(const std::string &name, Node &node, Duration now);
    void Reschedule(const std::string &name, Node &node);
    static Ask AskOf(const std::string &name, Node &node, bool now);
    Duration Spread(std::size_t others);

    const TakenIn _takenIn;
    const RandomSource _random;
    std::map<std::string, Node> _nodes;
    std::set<std::pair<Duration, std::string>> _due;
    std::set<std::string> _asked;    // nodes of which something is asked
    std::set<std::string> _changed;  // nodes whose requests have ended, which Take has not returned yet
};

}  // namespace Rabit
