#include "agreement/TableEntry.h"

#include <rabit/base/LittleEndian.h>
#include <rabit/base/WireBytes.h>

#include <algorithm>
#include <string_view>
#include <utility>

namespace Rabit
{
namespace
{

std::string BitmapOf(const NumberSet &numbers)
{
    std::vector<std::uint8_t> bitmap(numbers.size() / 8);
    for (std::size_t number = 0; number < numbers.size(); ++number)
    {
        const unsigned bit = numbers.test(number) ? 1U << (number % 8) : 0U;
        bitmap[number / 8] = static_cast<std::uint8_t>(bitmap[number / 8] | bit);
    }
    while (!bitmap.empty() && bitmap.back() == 0)
    {
        bitmap.pop_back();
    }
    return {bitmap.begin(), bitmap.end()};
}

// The bitmap must have at most 64 bytes.
NumberSet NumbersIn(std::string_view bitmap)
{
    NumberSet numbers;
    for (std::size_t number = 0; number < bitmap.size() * 8; ++number)
    {
        const unsigned byte = static_cast<std::uint8_t>(bitmap[number / 8]);
        numbers.set(number, ((byte >> (number % 8)) & 1U) != 0);
    }
    return numbers;
}

}  // namespace

TableValue MergedTableValue(const TableValue &one, const TableValue &other)
{
    if (one.index() != other.index())
    {
        return one.index() > other.index() ? one : other;
    }
    if (const auto *written = std::get_if<LastWritten>(&one))
    {
        return TableValue(std::in_place_type<LastWritten>, std::max(*written, std::get<LastWritten>(other)));
    }
    if (const auto *numbers = std::get_if<NumberSet>(&one))
    {
        return TableValue(std::in_place_type<NumberSet>, *numbers | std::get<NumberSet>(other));
    }
    return TableValue(std::in_place_type<std::int64_t>,
                      std::max(std::get<std::int64_t>(one), std::get<std::int64_t>(other)));
}

bool HasGoodKey(const TableEntry &entry)
{
    return !entry.Key.empty() && entry.Key.size() <= TableEntry::LongestKey;
}

bool HasGoodValue(const TableEntry &entry)
{
    const auto *written = std::get_if<LastWritten>(&entry.Value);
    return written == nullptr ||
           (!written->Writer.empty() && written->Writer.size() <= TableEntry::LongestWriter &&
            written->Value.size() <= TableEntry::LongestValue);
}

void PutTableEntry(const TableEntry &entry, std::vector<std::uint8_t> &bytes)
{
    bytes.push_back(static_cast<std::uint8_t>(MergeOf(entry.Value)));
    PutName(entry.Key, bytes);
    if (const auto *written = std::get_if<LastWritten>(&entry.Value))
    {
        LittleEndian::Put(written->Count, bytes);
        PutName(written->Writer, bytes);
        PutName(written->Value, bytes);
    }
    else if (const auto *numbers = std::get_if<NumberSet>(&entry.Value))
    {
        PutName(BitmapOf(*numbers), bytes);
    }
    else
    {
        LittleEndian::Put(static_cast<std::uint64_t>(std::get<std::int64_t>(entry.Value)), bytes);
    }
}

TableEntry TakeTableEntry(WireReader &from)
{
    const TableMerge merge = from.Enumerator(TableMerge::Maximum);
    TableEntry entry;
    entry.Key = from.Name(1, TableEntry::LongestKey);
    switch (merge)
    {
        case TableMerge::LastWriter:
        {
            LastWritten &written = entry.Value.emplace<LastWritten>();
            written.Count = from.Fixed<std::uint64_t>();
            written.Writer = from.Name(1, TableEntry::LongestWriter);
            written.Value = from.Name(0, TableEntry::LongestValue);
            break;
        }
        case TableMerge::Union:
            entry.Value.emplace<NumberSet>(NumbersIn(from.Name(0, NumberSet().size() / 8)));
            break;
        case TableMerge::Maximum:
            entry.Value.emplace<std::int64_t>(static_cast<std::int64_t>(from.Fixed<std::uint64_t>()));
            break;
    }
    return entry;
}

}  // namespace Rabit
