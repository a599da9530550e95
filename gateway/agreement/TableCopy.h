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

    enum class Answer : std::uint8_t
    {
        Done,
        BadKey,      // empty, or longer than 64 bytes
        BadValue,    // longer than 64 bytes, or a number above 511
        OtherMerge,  // of a call of this node: the key has a value of another merge
        Full,        // 256 other keys are known
        CountAtEnd   // another node has used the highest count of all
    };
    // A sentence for logs and problems.
    static std::string_view Reason(Answer answer);

    // Hash of a key to the sum of the hashes of its entries. That is one entry, unless hashes of keys
    // collide.
    using Pairs = std::map<std::uint64_t, std::uint64_t>;

    // The name of this node, at most 64 bytes; and another number for each start, which should rise.
    TableCopy(std::string self, std::uint64_t incarnation);

    // Last writer: the key has this value from now on. Without effect if it has it already.
    Answer Write(const std::string &key, std::string value);
    // Union: the set of the key has this number (0 to 511) from now on.
    Answer Add(const std::string &key, std::size_t number);
    // Maximum: the number of the key is this one at least.
    Answer Raise(const std::string &key, std::int64_t number);

    // Null: the key is not known. The pointer is good until the next call of a function that is not const.
    const TableValue *Find(std::string_view key) const;
    // All entries, in the order of their keys.
    std::vector<TableEntry> Entries() const;
    // Keys whose value has changed since the last call, by this node or by others.
    std::set<std::string> TakeChanged() { return std::exchange(_changed, {}); }

    // Merges an entry of another node.
    Answer Meet(const TableEntry &met) { return Merge(met, false); }

    // The same for the same table, and in all likelihood for no other one; 0: the table is empty.
    std::uint64_t Digest() const { return _digest; }
    const Pairs &Summary() const { return _summary; }
    std::vector<TableEntry> EntriesOf(std::uint64_t keyHash) const;
    std::size_t Room() const { return MostKeys - _items.size(); }

    // Calls of this node and entries of others that were refused, each copy of an entry.
    std::uint64_t Refused() const { return _refused; }
    // Keys that another node has, and that are not asked for: there is no room.
    void RefuseUnasked(std::size_t keys) { _refused += keys; }
    // Keys that nodes used with different merges, so that a value of the lower one was lost; and how often.
    const std::map<std::string, std::uint64_t> &Conflicts() const { return _conflicts; }
    // How often this node met a write under its own name that is not of this incarnation, and wrote its value
    // again.
    std::uint64_t Rewritten() const { return _rewritten; }

private:
    struct Item
    {
        TableEntry Entry{};
        std::uint64_t KeyHash = 0;
        std::uint64_t Hash = 0;      // of the entry
        bool IsWrittenHere = false;  // in this incarnation, by Write
        int Rewrites = 0;
    };
    using Items = std::map<std::string, Item, std::less<>>;

    Answer Refuse(Answer reason);
    Answer Merge(const TableEntry &entry, bool isOwn);
    Answer Insert(const TableEntry &entry);
    void Change(Item &item, TableValue value);
    // Returns false if there is nothing to outbid.
    bool OutbidFormerIncarnation(Item &item, TableValue &merged);

    const std::string _self;
    const std::uint64_t _incarnation;
    Items _items;
    Pairs _summary;
    std::uint64_t _digest = 0;
    std::set<std::string> _changed;
    std::map<std::string, std::uint64_t> _conflicts;
    std::uint64_t _refused = 0;
    std::uint64_t _rewritten = 0;
};

}  // namespace Rabit
