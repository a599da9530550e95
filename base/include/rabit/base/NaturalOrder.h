#pragma once

#include <algorithm>
#include <cstddef>
#include <string_view>

namespace Rabit
{

// Orders names as people expect, by the numbers in them: `uav2` before `uav10`, and `uav09` before `uav010`.
// Names that differ in leading zeros alone, as `uav1` and `uav01`, are not equal.
struct NaturalOrder
{
    bool operator()(std::string_view one, std::string_view other) const
    {
        std::string_view a = one;
        std::string_view b = other;
        while (!a.empty() && !b.empty())
        {
            if (IsDigit(a.front()) && IsDigit(b.front()))
            {
                const std::string_view first = TakeNumber(a);
                const std::string_view second = TakeNumber(b);
                if (first.size() != second.size())
                {
                    return first.size() < second.size();
                }
                if (first != second)
                {
                    return first < second;
                }
                continue;
            }
            if (a.front() != b.front())
            {
                return static_cast<unsigned char>(a.front()) < static_cast<unsigned char>(b.front());
            }
            a.remove_prefix(1);
            b.remove_prefix(1);
        }
        return a.empty() == b.empty() ? one < other : a.empty();
    }

private:
    static bool IsDigit(char c) { return c >= '0' && c <= '9'; }
    // Takes a number from the front. Returns its digits without leading zeros.
    static std::string_view TakeNumber(std::string_view &text)
    {
        const auto end = static_cast<std::size_t>(
            std::find_if_not(text.begin(), text.end(), &NaturalOrder::IsDigit) - text.begin());
        std::string_view digits = text.substr(0, end);
        text.remove_prefix(end);
        digits.remove_prefix(std::min(digits.find_first_not_of('0'), digits.size()));
        return digits;
    }
};

}  // namespace Rabit
