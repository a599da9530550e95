#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "agreement/TableEntry.h"

namespace Rabit
{

// Keys to small values that merge. Nodes that met each other have the same table, directly or over others,
// whatever met whom in whatever order. That holds for 256 keys in the whole fleet.
//
// Each key names its merge: last writer, union, maximum (Shapiro et al. 2011, state-based CRDTs). A last
// writer loses concurrent writes: one of them is kept. Nothing is deleted. The table lives in memory: a node
// that starts again has what the others tell it.
//
// A pure state machine. Not thread-safe.
class TableCopy
{
public:
    static constexpr std::size_t MostKeys = 256;
    // How often a value is written again (Rewritten) before the next Write. Bounds what two live nodes with
    // one name do to each other.
    static constexpr int MostRewrites = 16;

    // Why a key or a value was refused, in words; or nothing.
    struct Answer
    {
        static constexpr std::string_view Done = "";
        static constexpr std::string_view BadKey = "a key needs 1 to 64 bytes";
        static constexpr std::string_view BadValue =
            "a value has at most 64 bytes, and a number of a set is 0 to 511";
        // Of a call of this node.
        static constexpr std::string_view OtherMerge = "the key has a value of another merge";
        static constexpr std::string_view Full =
            "the table has 256 other keys; use fewer keys in the whole fleet";
        // Another node has used it.
        static constexpr std::string_view CountAtEnd =
            "the key has the highest count of all; use another key";
    };

    // The name of this node, at most 64 bytes; and another number for each start, which should rise.
    TableCopy(std::string self, std::uint64_t incarnation);

    // Last writer: the key has this value from now on. Without effect if it has it already.
    std::string_view Write(const std::string &key, std::string value);
    // Union: the set of the key has this number (0 to 511) from now on.
    std::string_view Add(const std::string &key, std::size_t number);
    // Maximum: the number of the key is this one at least.
    std::string_view Raise(const std::string &key, std::int64_t number);

    // Null: the key is not known. The pointer is good until the next call of a function that is not const.
    const TableValue *Find(std::string_view key) const;
    // All entries, in the order of their keys.
    std::vector<TableEntry> Entries() const;
    // Keys whose value has changed since the last call, by this node or by others.
    std::set<std::string> TakeChanged() { return std::exchange(_changed, {}); }

    // Merges an entry of another node.
    std::string_view Meet(const TableEntry &met) { return Merge(met, false); }

    // The same for the same table, and in all likelihood for no other one; 0: the table is empty.
    std::uint64_t Digest() const { return _digest; }
    // A hash of each entry. Entries that have one hash under a salt have two under most others.
    std::vector<std::uint32_t> Hashes(std::uint32_t salt) const;
    // The entries whose hash is not among these.
    std::vector<TableEntry> EntriesBeside(const std::vector<std::uint32_t> &hashes, std::uint32_t salt) const;

    // True if a key was refused since the last call, by this node or of another one, as the table is full.
    bool TakeRefusal() { return std::exchange(_wasFull, false); }
    // Keys that nodes used with different merges since the last call, so that a value of the lower one was
    // lost.
    std::set<std::string> TakeConflicts() { return std::exchange(_conflicts, {}); }
    // How often this node met a write under its own name that is not of this incarnation, and wrote its value
    // again.
    std::uint64_t Rewritten() const { return _rewritten; }

private:
    struct Item
    {
        TableEntry Entry{};
        std::uint64_t Hash = 0;      // of the entry
        bool IsWrittenHere = false;  // in this incarnation, by Write
        int Rewrites = 0;
    };
    using Items = std::map<std::string, Item, std::less<>>;

    std::string_view Merge(const TableEntry &entry, bool isOwn);
    std::string_view Insert(const TableEntry &entry);
    void Change(Item &item, TableValue value);
    // Returns false if there is nothing to outbid.
    bool OutbidFormerIncarnation(Item &item, TableValue &merged);

    const std::string _self;
    const std::uint64_t _incarnation;
    Items _items;
    std::uint64_t _digest = 0;
    std::set<std::string> _changed;
    std::set<std::string> _conflicts;
    bool _wasFull = false;
    std::uint64_t _rewritten = 0;
};

}  // namespace Rabit
