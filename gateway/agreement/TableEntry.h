// A key of a shared table, and its value. Numbers are little-endian; a name is a byte for its length, and its
// bytes.
//
//   entry:       merge (1), key, value
//   last writer: count (8), writer, value
//   union:       a name that is the bitmap, the number 0 lowest, without zero bytes at its end
//   maximum:     number (8)
#pragma once

#include <rabit/base/WireBytes.h>

#include <bitset>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace Rabit
{

// How two values of one key merge. If two nodes use one key with different merges, the higher one wins whole.
enum class TableMerge : std::uint8_t
{
    LastWriter,
    Union,
    Maximum
};

// A value that was written. The higher one of two is kept: by count, then by writer, then by value.
struct LastWritten
{
    std::uint64_t Count = 0;
    std::string Writer{};  // name of a node
    std::string Value{};   // any bytes
    auto operator<=>(const LastWritten &) const = default;
};
// A set of numbers from 0 to 511. A set of strings could outgrow its bound where two nodes meet.
using NumberSet = std::bitset<512>;
// In the order of TableMerge.
using TableValue = std::variant<LastWritten, NumberSet, std::int64_t>;

struct TableEntry
{
    static constexpr std::size_t LongestKey = 64;     // in bytes
    static constexpr std::size_t LongestValue = 64;   // in bytes
    static constexpr std::size_t LongestWriter = 64;  // in bytes

    std::string Key{};
    TableValue Value{};
    bool operator==(const TableEntry &) const = default;
};

// Returns the merged value of both. Commutative, associative and idempotent.
TableValue MergedTableValue(const TableValue &one, const TableValue &other);
inline TableMerge MergeOf(const TableValue &value)
{
    return static_cast<TableMerge>(value.index());
}

// Returns false if a name or a value is empty that must not be, or is too long.
bool HasGoodKey(const TableEntry &entry);
bool HasGoodValue(const TableEntry &entry);

// Writes a good entry.
void PutTableEntry(const TableEntry &entry, std::vector<std::uint8_t> &bytes);
// Returns a good entry, or leaves `from` bad.
TableEntry TakeTableEntry(WireReader &from);

}  // namespace Rabit
