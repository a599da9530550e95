#include "types/TypeAnswers.h"

#include <algorithm>

#include "wire/TypeFrames.h"

namespace Rabit
{

void TypeAnswers::Asked(const std::string &node, std::uint64_t definition, std::size_t from, Duration now)
{
    const std::string *text = _textOf(definition);
    if (text == nullptr || text->size() > TypeFrames::LargestText || from >= text->size())
    {
        ++_unknown;
        return;
    }
    const Key key(node, definition);
    std::erase_if(_memory, [now](const auto &entry)
                  { return now - entry.second.LastAsked >= Quiet && now >= entry.second.NotBefore; });
    const auto waiting =
        std::find_if(_waiting.begin(), _waiting.end(),
                     [&key](const Part &part) { return Key(part.Node, part.Definition) == key; });
    if (waiting != _waiting.end())
    {
        // The answer under way brings the rest; the asking node requests lost earlier parts again.
        _memory[key].LastAsked = now;
        return;
    }
    if (_waiting.size() >= MostWaiting || (_memory.size() >= MostRemembered && _memory.count(key) == 0))
    {
        ++_dropped;
        return;
    }
    Memory &memory = _memory[key];
    memory.LastAsked = now;
    if (now >= memory.NotBefore)
    {
        _waiting.push_back({.Node = node, .Definition = definition, .First = from, .Text = text});
    }
}

std::optional<TypeAnswers::Duration> TypeAnswers::Due() const
{
    return _waiting.empty() ? std::nullopt : std::optional(_notBefore);
}

TypeAnswers::Part TypeAnswers::Next() const
{
    return _waiting.front();
}

void TypeAnswers::Sent(std::size_t bytes, Duration now)
{
    _notBefore = now + PartGap;
    Part &part = _waiting.front();
    part.First += bytes;
    if (part.First >= part.Text->size())
    {
        Memory &memory = _memory[{part.Node, part.Definition}];
        memory.NotBefore = now + memory.Gap;
        memory.Gap = std::min(2 * memory.Gap, LongestGap);
        _waiting.pop_front();
    }
}

}  // namespace Rabit
