#pragma once

#include <rabit/base/LittleEndian.h>

#include "recording/mcap/McapRecords.h"

namespace Rabit::Mcap
{

// Reads the fields of one record from untrusted bytes, which must not become many times their size in memory.
// After the first field that does not fit, IsGood is false, and every further read returns an empty value.
class FieldReader
{
public:
    // Texts() fails if its result would take more memory: an entry of 8 bytes becomes one of TextEntrySize.
    static constexpr std::size_t LargestTexts = 64U << 20;

    explicit FieldReader(ByteView bytes) : _left(bytes) {}

    bool IsGood() const { return _good; }
    bool IsEnd() const { return _left.empty(); }

    template <typename T>
    T Number()
    {
        return LittleEndian::Read<T>(Raw(sizeof(T)));
    }
    ByteView Raw(std::uint64_t size)
    {
        if (!_good || size > _left.size())
        {
            _good = false;
            _left = {};
            return {};
        }
        const ByteView bytes = _left.first(static_cast<std::size_t>(size));
        _left = _left.subspan(bytes.size());
        return bytes;
    }
    std::string Text()
    {
        const ByteView bytes = Raw(Number<std::uint32_t>());
        return {bytes.begin(), bytes.end()};
    }
    TextMap Texts()
    {
        FieldReader entries(Raw(Number<std::uint32_t>()));
        TextMap texts;
        std::size_t bytes = 0;
        while (entries.IsGood() && !entries.IsEnd())
        {
            std::string key = entries.Text();
            std::string value = entries.Text();
            bytes += TextEntrySize + key.size() + value.size();
            entries._good = entries._good && bytes <= LargestTexts;
            if (entries.IsGood())
            {
                texts.insert_or_assign(std::move(key), std::move(value));
            }
        }
        Join(entries);
        return texts;
    }
    // Calls take(first, second) for each pair of an array.
    template <typename First, typename Second, typename Take>
    void NumberPairs(Take take)
    {
        FieldReader entries(Raw(Number<std::uint32_t>()));
        while (entries.IsGood() && !entries.IsEnd())
        {
            const auto first = entries.Number<First>();
            const auto second = entries.Number<Second>();
            if (entries.IsGood())
            {
                take(first, second);
            }
        }
        Join(entries);
    }
    ByteView Rest() { return Raw(_left.size()); }

private:
    void Join(const FieldReader &other) { _good = _good && other._good; }

    ByteView _left;
    bool _good = true;
};

}  // namespace Rabit::Mcap
