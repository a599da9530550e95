#include "types/TypeAnswers.h"

#include <algorithm>

#include "wire/NodeReports.h"
#include "wire/TypeFrames.h"

namespace Rabit
{

TypeAnswers::Key TypeAnswers::KeyOf(const std::string &node, std::uint64_t definition)
{
    const auto report = NodeReports::NameIn(definition);
    return {node, report ? NodeReports::NameOf(report->What) : definition};
}

void TypeAnswers::Asked(const std::string &node, std::uint64_t definition, std::size_t from, Duration now)
{
    const Key key = KeyOf(node, definition);
    std::erase_if(_memory, [now](const auto &entry)
                  { return now - entry.second.LastAsked >= Quiet && now >= entry.second.NotBefore; });
    const auto waiting =
        std::find_if(_waiting.begin(), _waiting.end(),
                     [&key](const Part &part) { return KeyOf(part.Node, part.Definition) == key; });
    if (waiting != _waiting.end())
    {
        _memory[key].LastAsked = now;
        // An answer that has begun brings the rest; the asking node requests lost earlier parts again. One
        // that has not begun is of no use any more if the node asks for another report of that kind.
        if (waiting->Definition != definition && waiting->First == 0)
        {
            if (std::shared_ptr<const std::string> text = TextFrom(definition, from))
            {
                *waiting = {.Node = node, .Definition = definition, .First = from, .Text = std::move(text)};
            }
        }
        return;
    }
    const auto known = _memory.find(key);
    if (known != _memory.end() && now < known->second.NotBefore)
    {
        known->second.LastAsked = now;
        return;
    }
    if (_waiting.size() >= MostWaiting || (_memory.size() >= MostRemembered && _memory.count(key) == 0))
    {
        ++_dropped;
        return;
    }
    // A report is written when it is requested, so not for a question that gets no answer.
    std::shared_ptr<const std::string> text = TextFrom(definition, from);
    if (text == nullptr)
    {
        return;
    }
    Memory &memory = _memory[key];
    memory.LastAsked = now;
    _waiting.push_back({.Node = node, .Definition = definition, .First = from, .Text = std::move(text)});
}

std::shared_ptr<const std::string> TypeAnswers::TextFrom(std::uint64_t definition, std::size_t from)
{
    std::shared_ptr<const std::string> text = _textOf(definition);
    if (text == nullptr || text->size() > TypeFrames::LargestText || from >= text->size())
    {
        ++_unknown;
        return nullptr;
    }
    return text;
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
        Memory &memory = _memory[KeyOf(part.Node, part.Definition)];
        memory.NotBefore = now + memory.Gap.Next();
        // An answer that is no larger than the question needs no larger interval.
        const auto report = NodeReports::NameIn(part.Definition);
        if (report && report->What == NodeReports::Kind::Echo)
        {
            memory.Gap.Reset();
        }
        _waiting.pop_front();
    }
}

}  // namespace Rabit
