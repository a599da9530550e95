#include "air/TrafficClassWords.h"

#include <array>

namespace Rabit
{
namespace
{

constexpr std::array<const char *, TrafficClassCount> Words = {"presence", "command", "state", "telemetry",
                                                               "bulk"};

}  // namespace

const char *WordOf(TrafficClass traffic)
{
    return Words.at(static_cast<std::size_t>(traffic));
}

const std::vector<std::string> &TrafficClassWords()
{
    static const std::vector<std::string> words(Words.begin() + 1, Words.end());
    return words;
}

TrafficClass ChosenClass(std::size_t index)
{
    return static_cast<TrafficClass>(index + 1);
}

}  // namespace Rabit
