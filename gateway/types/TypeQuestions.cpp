#include "types/TypeQuestions.h"

#include <algorithm>

#include "names/TakeTurns.h"
#include "names/TypeDefinition.h"

namespace Rabit
{

bool TypeQuestions::Want(const Wanted &wanted, Duration now)
{
    const auto found = _wanted.find(wanted.Definition);
    if (found != _wanted.end() && found->second.Node == wanted.Node)
    {
        return true;
    }
    if (found == _wanted.end() && _wanted.size() >= MostWanted)
    {
        return false;
    }
    // Texts of one hash may differ in comments, so parts of two nodes cannot be joined.
    Entry &entry = _wanted[wanted.Definition];
    entry = {};
    entry.Node = wanted.Node;
    entry.Type = wanted.Type;
    entry.AskAt = now;
    return true;
}

std::optional<TypeQuestions::Duration> TypeQuestions::NextDue() const
{
    std::optional<Duration> next;
    for (const auto &[definition, entry] : _wanted)
    {
        next = std::min(next.value_or(entry.AskAt), entry.AskAt);
    }
    return next;
}

std::size_t TypeQuestions::Due(Duration now, std::size_t most) const
{
    const auto due = std::count_if(_wanted.begin(), _wanted.end(),
                                   [now](const auto &entry) { return entry.second.AskAt <= now; });
    return std::min(static_cast<std::size_t>(due), most);
}

std::vector<TypeQuestions::Question> TypeQuestions::Take(Duration now, std::size_t most)
{
    std::vector<Question> questions;
    TakeTurns(_wanted, _lastAsked, most,
              [&](std::uint64_t definition, Entry &entry)
              {
                  if (entry.AskAt > now)
                  {
                      return false;
                  }
                  questions.push_back(
                      {entry.Node, definition, static_cast<std::uint32_t>(entry.Collected.FirstLacking())});
                  entry.AskAt = now + entry.Gap;
                  entry.Gap = std::min(2 * entry.Gap, LongestGap);
                  return true;
              });
    return questions;
}

std::optional<std::string> TypeQuestions::Add(const std::string &node, const TypeFrames::Part &part)
{
    const auto found = _wanted.find(part.Definition);
    if (found == _wanted.end() || found->second.Node != node)
    {
        ++_wrong;
        return std::nullopt;
    }
    Entry &entry = found->second;
    PartsCollector &collected = entry.Collected;
    if (collected.Size() != part.Of)
    {
        collected.Begin(part.Of);
    }
    collected.Add(part.First, part.Bytes);
    if (!collected.IsComplete())
    {
        return std::nullopt;
    }
    std::string text(collected.Bytes().begin(), collected.Bytes().end());
    if (DefinitionHash(entry.Type, text) != part.Definition)
    {
        ++_wrong;
        collected.Begin(0);
        return std::nullopt;
    }
    _wanted.erase(found);
    return text;
}

}  // namespace Rabit
