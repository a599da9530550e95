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

}  // namespace

TableCopy::TableCopy(std::string self, std::uint64_t incarnation)
    : _self(CheckedWriter(std::move(self))), _incarnation(incarnation)
{
}

std::string_view TableCopy::Reason(Answer answer)
{
    switch (answer)
    {
        case Answer::Done:
            return "done";
        case Answer::BadKey:
            return "a key needs 1 to 64 bytes";
        case Answer::BadValue:
            return "a value has at most 64 bytes, and a number of a set is 0 to 511";
        case Answer::OtherMerge:
            return "the key has a value of another merge";
        case Answer::Full:
            return "the table has 256 other keys; use fewer keys in the whole fleet";
        case Answer::CountAtEnd:
            return "the key has the highest count of all; use another key";
    }
    return "unknown";
}

TableCopy::Answer TableCopy::Write(const std::string &key, std::string value)
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
        return Refuse(Answer::CountAtEnd);
    }
    if (last != nullptr)
    {
        written.Count = std::max(_incarnation, last->Count + 1);
    }
    TableEntry own;
    own.Key = key;
    own.Value = std::move(written);
    const Answer answer = Merge(own, true);
    if (answer == Answer::Done)
    {
        Item &item = _items.find(key)->second;
        item.IsWrittenHere = true;
        item.Rewrites = 0;
    }
    return answer;
}

TableCopy::Answer TableCopy::Add(const std::string &key, std::size_t number)
{
    NumberSet numbers;
    if (number >= numbers.size())
    {
        return Refuse(Answer::BadValue);
    }
    numbers.set(number);
    TableEntry own;
    own.Key = key;
    own.Value.emplace<NumberSet>(numbers);
    return Merge(own, true);
}

TableCopy::Answer TableCopy::Raise(const std::string &key, std::int64_t number)
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

std::vector<TableEntry> TableCopy::EntriesOf(std::uint64_t keyHash) const
{
    std::vector<TableEntry> entries;
    for (const auto &[key, item] : _items)
    {
        if (item.KeyHash == keyHash)
        {
            entries.push_back(item.Entry);
        }
    }
    return entries;
}

TableCopy::Answer TableCopy::Refuse(Answer reason)
{
    ++_refused;
    return reason;
}

TableCopy::Answer TableCopy::Merge(const TableEntry &entry, bool isOwn)
{
    if (!HasGoodKey(entry) || !HasGoodValue(entry))
    {
        return Refuse(HasGoodKey(entry) ? Answer::BadValue : Answer::BadKey);
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
            return Refuse(Answer::OtherMerge);
        }
        // To refuse would leave two tables apart for ever.
        ++_conflicts[entry.Key];
    }
    TableValue merged = MergedTableValue(item.Entry.Value, entry.Value);
    if (merged != item.Entry.Value)
    {
        _rewritten += !isOwn && OutbidFormerIncarnation(item, merged) ? 1U : 0U;
        Change(item, std::move(merged));
    }
    return Answer::Done;
}

TableCopy::Answer TableCopy::Insert(const TableEntry &entry)
{
    if (_items.size() >= MostKeys)
    {
        return Refuse(Answer::Full);
    }
    Item &item = _items[entry.Key];
    item.Entry.Key = entry.Key;
    item.KeyHash = Fnv1a().Add(entry.Key).Sum();
    Change(item, entry.Value);
    return Answer::Done;
}

void TableCopy::Change(Item &item, TableValue value)
{
    item.Entry.Value = std::move(value);
    const std::uint64_t hash = HashOfEntry(item.Entry);
    _summary[item.KeyHash] += hash - item.Hash;
    item.Hash = hash;
    Fnv1a digest;
    for (const auto &[key, entries] : _summary)
    {
        digest.AddNumber(key).AddNumber(entries);
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
