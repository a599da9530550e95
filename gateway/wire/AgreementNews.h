#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace Rabit
{

// The agreement of a node (gateway/agreement), as its beats tell it.
struct AgreementNews
{
    // Bytes of one extension of Answers. Receivers of all versions take extensions of 64 bytes.
    static constexpr std::size_t AnswersOfOne = 52;
    static constexpr std::size_t MostAnswers = 4 * AnswersOfOne;

    std::uint32_t Group = 0;              // hash of the sender's members and lease
    std::uint64_t Table = 0;              // digest of its shared table; 0: empty
    std::vector<std::uint8_t> Renewal{};  // AgreementNode::Beat
    std::vector<std::uint8_t> Answers{};  // likewise, at most MostAnswers bytes
    bool operator==(const AgreementNews &) const = default;
};

}  // namespace Rabit
