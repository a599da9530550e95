#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace Rabit
{

// The names of a node's recordings: NODE_000042_20261123T024640Z.mcap, numbered from 1 on.
struct RecordingName
{
    static constexpr std::size_t NumberDigits = 6;  // at least
    static constexpr std::size_t DateLetters = 16;  // 20261123T024640Z
    static constexpr std::string_view End = ".mcap";

    std::uint64_t Number = 0;
    // False for a file that was made from a recording and named after it, as `rabit recover` does.
    bool IsOriginal = true;

    // Without the end.
    static std::string Stem(const std::string &node, std::uint64_t number, const std::string &date)
    {
        const std::string digits = std::to_string(number);
        std::string stem = node;
        stem.append("_").append(NumberDigits - std::min(NumberDigits, digits.size()), '0').append(digits);
        return stem.append("_").append(date);
    }
    // Empty if the file is none of this node; uav1_cam_000001_... is none of uav1.
    static std::optional<RecordingName> Of(std::string_view file, std::string_view node)
    {
        if (!file.starts_with(node) || !file.ends_with(End) || file.size() < node.size() + 1 + End.size() ||
            file[node.size()] != '_')
        {
            return std::nullopt;
        }
        const std::string_view rest =
            file.substr(node.size() + 1, file.size() - node.size() - 1 - End.size());
        const std::string_view digits = rest.substr(0, std::min(rest.find('_'), rest.size()));
        if (digits.size() < NumberDigits || digits.size() > 18 || !AreDigits(digits) ||
            rest.size() < digits.size() + 1 + DateLetters)
        {
            return std::nullopt;
        }
        const std::string_view date = rest.substr(digits.size() + 1, DateLetters);
        if (!AreDigits(date.substr(0, 8)) || date[8] != 'T' || !AreDigits(date.substr(9, 6)) ||
            date[15] != 'Z')
        {
            return std::nullopt;
        }
        RecordingName name;
        for (const char digit : digits)
        {
            name.Number = name.Number * 10 + static_cast<std::uint64_t>(digit - '0');
        }
        name.IsOriginal = rest.size() == digits.size() + 1 + DateLetters;
        return name;
    }

private:
    static bool AreDigits(std::string_view text)
    {
        return std::all_of(text.begin(), text.end(),
                           [](char letter) { return letter >= '0' && letter <= '9'; });
    }
};

}  // namespace Rabit
