#include "agreement/TableCopy.h"

#include <rabit/base/Fnv1a.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace Rabit
{
namespace
{

constexpr std::uint64_t LastCount = std::numeric_limits<std::uint64_t>::max();

std::string CheckedWriter(std::string name)
{
    if (name.empty() || name.size() > TableEntry::LongestWriter)
    {
        throw std::invalid_argument("a shared table needs the node's name, of at most 64 bytes");
    }
    return name;
}

std::uint64_t HashOfEntry(const TableEntry &entry)
{
    std::vector<std::uint8_t> bytes;
    PutTableEntry(entry, bytes);
    return Fnv1a().Add(bytes).Sum();
}

std::uint32_t Salted(std::uint64_t hash, std::uint32_t salt)
{
    return Fnv1a().AddNumber(salt).AddNumber(hash).Folded();
}

}  // namespace

TableCopy::TableCopy(std::string self, std::uint64_t incarnation)
    : _self(CheckedWriter(std::move(self))), _incarnation(incarnation)
{
}

std::string_view TableCopy::Write(const std::string &key, std::string value)
{
    const auto known = _items.find(key);
    LastWritten written{.Count = _incarnation, .Writer = _self, .Value = std::move(value)};
    const auto *last = known == _items.end() ? nullptr : std::get_if<LastWritten>(&known->second.Entry.Value);
    if (last != nullptr && last->Value == written.Value)
    {
        known->second.IsWrittenHere = true;
        known->second.Rewrites = 0;
        return Answer::Done;
    }
    if (last != nullptr && last->Count == LastCount)
    {
        return Answer::CountAtEnd;
    }
    if (last != nullptr)
    {
        written.Count = std::max(_incarnation, last->Count + 1);
    }
    TableEntry own;
    own.Key = key;
    own.Value = std::move(written);
    const std::string_view answer = Merge(own, true);
    if (answer == Answer::Done)
    {
        Item &item = _items.find(key)->second;
        item.IsWrittenHere = true;
        item.Rewrites = 0;
    }
    return answer;
}

std::string_view TableCopy::Add(const std::string &key, std::size_t number)
{
    NumberSet numbers;
    if (number >= numbers.size())
    {
        return Answer::BadValue;
    }
    numbers.set(number);
    TableEntry own;
    own.Key = key;
    own.Value.emplace<NumberSet>(numbers);
    return Merge(own, true);
}

std::string_view TableCopy::Raise(const std::string &key, std::int64_t number)
{
    TableEntry own;
    own.Key = key;
    own.Value.emplace<std::int64_t>(number);
    return Merge(own, true);
}

const TableValue *TableCopy::Find(std::string_view key) const
{
    const auto known = _items.find(key);
    return known == _items.end() ? nullptr : &known->second.Entry.Value;
}

std::vector<TableEntry> TableCopy::Entries() const
{
    std::vector<TableEntry> entries;
    for (const auto &[key, item] : _items)
    {
        entries.push_back(item.Entry);
    }
    return entries;
}

std::vector<std::uint32_t> TableCopy::Hashes(std::uint32_t salt) const
{
    std::vector<std::uint32_t> hashes;
    for (const auto &[key, item] : _items)
    {
        hashes.push_back(Salted(item.Hash, salt));
    }
    return hashes;
}

std::vector<TableEntry> TableCopy::EntriesBeside(const std::vector<std::uint32_t> &hashes,
                                                 std::uint32_t salt) const
{
    const std::set<std::uint32_t> known(hashes.begin(), hashes.end());
    std::vector<TableEntry> entries;
    for (const auto &[key, item] : _items)
    {
        if (!known.contains(Salted(item.Hash, salt)))
        {
            entries.push_back(item.Entry);
        }
    }
    return entries;
}

std::string_view TableCopy::Merge(const TableEntry &entry, bool isOwn)
{
    if (!HasGoodKey(entry) || !HasGoodValue(entry))
    {
        return HasGoodKey(entry) ? Answer::BadValue : Answer::BadKey;
    }
    const auto known = _items.find(entry.Key);
    if (known == _items.end())
    {
        return Insert(entry);
    }
    Item &item = known->second;
    if (MergeOf(item.Entry.Value) != MergeOf(entry.Value))
    {
        if (isOwn)
        {
            return Answer::OtherMerge;
        }
        // To refuse would leave two tables apart for ever.
        _conflicts.insert(entry.Key);
    }
    TableValue merged = MergedTableValue(item.Entry.Value, entry.Value);
    if (merged != item.Entry.Value)
    {
        _rewritten += !isOwn && OutbidFormerIncarnation(item, merged) ? 1U : 0U;
        Change(item, std::move(merged));
    }
    return Answer::Done;
}

std::string_view TableCopy::Insert(const TableEntry &entry)
{
    if (_items.size() >= MostKeys)
    {
        _wasFull = true;
        return Answer::Full;
    }
    Item &item = _items[entry.Key];
    item.Entry.Key = entry.Key;
    Change(item, entry.Value);
    return Answer::Done;
}

void TableCopy::Change(Item &item, TableValue value)
{
    item.Entry.Value = std::move(value);
    item.Hash = HashOfEntry(item.Entry);
    Fnv1a digest;
    for (const auto &[key, each] : _items)
    {
        digest.AddNumber(each.Hash);
    }
    _digest = digest.Sum();
    _changed.insert(item.Entry.Key);
}

// A former incarnation may have written with a higher count, if it had met a node whose incarnation is
// higher, or if incarnations fell. All that this incarnation writes is in its own table, so what it does not
// know is not from itself. Its value goes above that, as a router of OSPF does with advertisements of its
// own.
bool TableCopy::OutbidFormerIncarnation(Item &item, TableValue &merged)
{
    auto *written = std::get_if<LastWritten>(&merged);
    const auto *before = std::get_if<LastWritten>(&item.Entry.Value);
    if (written == nullptr || before == nullptr || written->Writer != _self || !item.IsWrittenHere ||
        written->Value == before->Value || written->Count == LastCount || item.Rewrites >= MostRewrites)
    {
        return false;
    }
    ++item.Rewrites;
    ++written->Count;
    written->Value = before->Value;
    return true;
}

}  // namespace Rabit
