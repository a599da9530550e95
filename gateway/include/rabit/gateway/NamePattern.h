#pragma once

#include <string>
#include <string_view>
#include <vector>

// The names of nodes, messages and queues, and patterns of them. These functions keep no state, so any thread
// may call them, and take any text, that of a stranger included.
namespace Rabit
{

// True if the name fits the pattern: `*` stands for any characters, `?` for one, as in DDS partitions (OMG
// DDS 1.4, 2.2.3.13). Takes time in proportion to the product of both lengths at most.
bool MatchesPattern(std::string_view pattern, std::string_view name);
// True if `wider` matches every name that `pattern` matches.
bool CoversPattern(std::string_view wider, std::string_view pattern);
// True if the name fits at least one of the patterns; false without patterns.
bool MatchesAny(const std::vector<std::string> &patterns, std::string_view name);

// True if the text is a node name: 1 to 64 of A-Z a-z 0-9 _ . -
bool IsNodeName(std::string_view text);

// True if the text is a pattern of node names: 1 to 64 characters of node names, `*` and `?`.
bool IsNodePattern(std::string_view text);

// True if the text can name a message or a queue: 1 to 200 of A-Z a-z 0-9 _ . - : /, where no part between
// slashes is empty.
bool IsMessageName(std::string_view text);

}  // namespace Rabit
