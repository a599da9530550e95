#include "types/TypeQuestions.h"

#include <algorithm>

#include "names/TakeTurns.h"
#include "names/TypeDefinition.h"
#include "wire/NodeReports.h"

namespace Rabit
{
namespace
{

// True if both are reports of one kind.
bool AreAlike(std::uint64_t definition, std::uint64_t other)
{
    const auto one = NodeReports::NameIn(definition);
    const auto two = NodeReports::NameIn(other);
    return one && two && one->What == two->What;
}

bool IsEcho(std::uint64_t definition)
{
    const auto name = NodeReports::NameIn(definition);
    return name && name->What == NodeReports::Kind::Echo;
}

}  // namespace

TypeQuestions::Key TypeQuestions::KeyOf(const Wanted &wanted)
{
    return {wanted.Definition, wanted.Type.empty() ? wanted.Node : ""};
}

bool TypeQuestions::Want(const Wanted &wanted, Duration now)
{
    if (wanted.Type.empty())
    {
        std::erase_if(_wanted,
                      [&wanted](const auto &entry)
                      {
                          const auto &[definition, node] = entry.first;
                          return node == wanted.Node && definition != wanted.Definition &&
                                 AreAlike(definition, wanted.Definition);
                      });
    }
    const auto found = _wanted.find(KeyOf(wanted));
    if (found != _wanted.end() && found->second.Node == wanted.Node)
    {
        return true;
    }
    if (found == _wanted.end() && _wanted.size() >= MostWanted)
    {
        return false;
    }
    // Texts of one hash may differ in comments, so parts of two nodes cannot be joined.
    Entry &entry = _wanted[KeyOf(wanted)];
    entry = {};
    entry.Node = wanted.Node;
    entry.Type = wanted.Type;
    entry.Ask.Begin(now);
    return true;
}

std::optional<TypeQuestions::Duration> TypeQuestions::NextDue() const
{
    return NextAsk(_wanted);
}

std::size_t TypeQuestions::Due(Duration now, std::size_t most) const
{
    return CountAsks(_wanted, now, most);
}

std::vector<TypeQuestions::Question> TypeQuestions::Take(Duration now, std::size_t most)
{
    std::vector<Question> questions;
    TakeTurns(_wanted, _lastAsked, most,
              [&](const Key &key, Entry &entry)
              {
                  if (!entry.Ask.IsDue(now))
                  {
                      return false;
                  }
                  questions.push_back(
                      {entry.Node, key.first, static_cast<std::uint32_t>(entry.Collected.FirstLacking())});
                  entry.AskedAt = now;
                  IsEcho(key.first) ? entry.Ask.Stop() : entry.Ask.Done(now);
                  return true;
              });
    return questions;
}

std::optional<TypeQuestions::Answer> TypeQuestions::Add(const std::string &node, const TypeFrames::Part &part)
{
    const auto report = _wanted.find({part.Definition, node});
    const auto found = report != _wanted.end() ? report : _wanted.find({part.Definition, ""});
    if (found == _wanted.end() || found->second.Node != node)
    {
        // A question for a report is repeated, so a second answer is not wrong.
        _wrong += NodeReports::NameIn(part.Definition) ? 0 : 1;
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
    std::optional<std::string> text(std::in_place, collected.Bytes().begin(), collected.Bytes().end());
    if (entry.Type.empty())
    {
        text = NodeReports::Opened(*text);
    }
    else if (DefinitionHash(entry.Type, *text) != part.Definition)
    {
        text.reset();
    }
    if (!text)
    {
        ++_wrong;
        collected.Begin(0);
        return std::nullopt;
    }
    Answer answer{std::move(*text), entry.AskedAt};
    _wanted.erase(found);
    return answer;
}

}  // namespace Rabit
