#pragma once

#include <string>
#include <vector>

namespace Rabit
{

// Returns "; did you mean `pose`?" for the candidate with the fewest edits (Levenshtein, 1966, ignoring
// case), if they are few enough for a typo; otherwise "; expected one of a, b, c" if there are at most ten
// candidates; otherwise nothing.
std::string NearestWordHint(const std::string &word, const std::vector<std::string> &candidates);

}  // namespace Rabit
