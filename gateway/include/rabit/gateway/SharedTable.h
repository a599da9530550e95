#pragma once

#include <rabit/RabitEvent.h>
#include <rabit/gateway/GatewayConfig.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace Rabit
{

// Small values that all nodes with an `agreement` share, and that merge: which cells are flown, the wind, the
// highest number that was given.
//
// The promise: nodes that have met have the same table, whatever met whom in whatever order, directly or over
// others. It needs no majority, and each write succeeds at once. A last writer loses concurrent writes: one
// of them is kept, the same one everywhere.
//
//     _table.Add("flown", 17);             // a set of numbers
//     _table.Write("wind", "12 m/s");      // the last writer's text
//     _table.Raise("sorties", 4);          // the highest number
//     if (_table.Numbers("flown").contains(3)) ...
//
// The promise holds under these conditions:
// - Clocks: none. Writes are ordered by a count, not by time.
// - Restarts: the table lives in memory. A node that starts has an empty table, and gets the others' once it
//   has met one of them. A value that no other node has is lost with its node.
// - Partitions: all sides go on, and merge once they meet. Tables are equal within some beats after that.
// - Nothing is deleted. There are 256 keys in the whole fleet; a table with other 256 keys refuses further
//   ones, and Gateway/Fleet has a problem.
//
// State-based data types that merge (CRDTs): Shapiro, Preguica, Baquero and Zawirski (2011).
//
// Threads: all functions may be called from any thread, and none waits for the network. All objects of one
// configuration and its copies have the same table, which the gateway of that configuration serves.
class SharedTable
{
public:
    static constexpr std::size_t MostKeys = 256;
    static constexpr std::size_t LongestKey = 64;      // bytes of any text, 1 at least
    static constexpr std::size_t LongestValue = 64;    // bytes of a text
    static constexpr std::size_t HighestNumber = 511;  // of a set

    // Before the gateway is made, as Claims. Throws ConfigError if the configuration has no `agreement`.
    explicit SharedTable(GatewayConfig &config);

    // Each returns why it was refused, in words; empty: it is done. A key keeps the kind of its first use. If
    // two nodes use one key in two ways before they meet, the number wins over the set, and that over the
    // text.
    std::string_view Write(const std::string &key, std::string value);
    std::string_view Add(const std::string &key, std::size_t number);  // to a set, 0 to HighestNumber
    std::string_view Raise(const std::string &key, std::int64_t number);

    // Empty: the key is not known, or of another kind.
    std::optional<std::string> Text(std::string_view key) const;
    std::set<std::size_t> Numbers(std::string_view key) const;
    std::optional<std::int64_t> Number(std::string_view key) const;
    std::vector<std::string> Keys() const;

    // Calls the handler after each change: on the thread that makes it, or, of changes by other nodes, as
    // Claims::ConnectChanged does.
    RabitConnection ConnectChanged(RabitHandler handler);

private:
    std::shared_ptr<AgreementHub> _hub;
};

}  // namespace Rabit
