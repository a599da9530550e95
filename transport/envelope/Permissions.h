// The list of topics that a node may write and read. Its certificate names the list by its hash. Bytes:
// format 1, and for each rule a byte (bit 0: may write, bit 1: may read), the length of the pattern, and the
// pattern.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "envelope/Certificate.h"

namespace Rabit::Envelope
{

class Permissions
{
public:
    struct Rule
    {
        // Name of a topic; `*` stands for any characters, `?` for one.
        std::string Topic;
        bool MayWrite = false;
        bool MayRead = false;
        bool operator==(const Rule &) const = default;
    };

    static constexpr std::size_t MostRules = 256;
    static constexpr std::size_t LongestTopic = 255;
    // Stars of one pattern. Matching takes at most the product of both lengths for each pattern.
    static constexpr std::size_t MostStars = 4;
    // A list must travel in a card (rtps/CardMessage.h).
    static constexpr std::size_t LargestList = 16 * 1024;

    // Empty if there are too many rules, if a pattern is empty or too long or has too many stars, if a rule
    // allows nothing, or if the list is too large.
    static std::optional<Permissions> Of(std::vector<Rule> rules);
    // Accepts any bytes; empty if they are no such list.
    static std::optional<Permissions> Read(std::span<const std::uint8_t> bytes);
    std::vector<std::uint8_t> Bytes() const;
    // The hash that a certificate holds.
    static Hash HashOf(std::span<const std::uint8_t> bytes);

    // True if a rule allows it. All other topics are forbidden. `role`: of all topics a tool may write the
    // gateways' own alone, which begin with `rabit/`.
    bool MayWrite(std::string_view topic, CertificateRole role) const;
    bool MayRead(std::string_view topic) const;
    const std::vector<Rule> &Rules() const { return _rules; }

private:
    explicit Permissions(std::vector<Rule> rules) : _rules(std::move(rules)) {}

    std::vector<Rule> _rules;
};

}  // namespace Rabit::Envelope
