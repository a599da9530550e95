#pragma once

#include <rabit/base/LittleEndian.h>
#include <rabit/mcap/McapRecords.h>

#include <type_traits>

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
    std::size_t Left() const { return _left.size(); }

    // These read one field each. A ByteView takes all that is left.
    template <typename T>
    void Get(T &number) requires(std::is_integral_v<T> || std::is_enum_v<T>)
    {
        using Unsigned = typename std::conditional_t<std::is_enum_v<T>, std::underlying_type<T>,
                                                     std::type_identity<T>>::type;
        number = static_cast<T>(Number<Unsigned>());
    }
    void Get(std::string &text)
    {
        const ByteView bytes = Raw(Number<std::uint32_t>());
        text.assign(bytes.begin(), bytes.end());
    }
    void Get(ByteView &rest) { rest = Raw(_left.size()); }
    void Get(TextMap &texts)
    {
        FieldReader entries(Raw(Number<std::uint32_t>()));
        std::size_t bytes = 0;
        while (entries.IsGood() && !entries.IsEnd())
        {
            std::string key;
            std::string value;
            entries.Get(key);
            entries.Get(value);
            bytes += TextEntrySize + key.size() + value.size();
            entries._good = entries._good && bytes <= LargestTexts;
            if (entries.IsGood())
            {
                texts.insert_or_assign(std::move(key), std::move(value));
            }
        }
        Join(entries);
    }
    // Pairs of numbers: a later one of the same key replaces an earlier one in a map.
    template <typename First, typename Second>
    void Get(std::map<First, Second> &pairs)
    {
        GetPairs<First, Second>([&pairs](First first, Second second) { pairs[first] = second; });
    }
    template <typename First, typename Second>
    void Get(std::vector<std::pair<First, Second>> &pairs)
    {
        GetPairs<First, Second>([&pairs](First first, Second second) { pairs.emplace_back(first, second); });
    }

private:
    template <typename First, typename Second, typename Take>
    void GetPairs(Take take)
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
    void Join(const FieldReader &other) { _good = _good && other._good; }

    ByteView _left;
    bool _good = true;
};

}  // namespace Rabit::Mcap
