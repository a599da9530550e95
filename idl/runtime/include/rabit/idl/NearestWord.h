#pragma once

#include <string>
#include <vector>

namespace Rabit
{

// "; did you mean `pose`?" for the candidate that differs from the word by the fewest edits (Levenshtein,
// 1966, ignoring case), if they are few enough to be a slip; otherwise "; expected one of a, b, c" if there
// are at most ten candidates; otherwise nothing.
std::string NearestWordHint(const std::string &word, const std::vector<std::string> &candidates);

}  // namespace Rabit
