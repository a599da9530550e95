#include "wire/BeatExtensions.h"

#include <algorithm>
#include <span>

#include "wire/LittleEndian.h"

namespace Rabit::BeatExtensions
{

using LittleEndian::Put;
using LittleEndian::Take;

namespace
{

Gateway::Wanted &Add(Gateway::Beat &beat, std::uint16_t kind)
{
    Gateway::Wanted &extension = beat.wants.emplace_back();
    extension.node = Nobody;
    extension.offers = kind;
    return extension;
}

bool Has(const Gateway::Beat &beat, std::uint16_t kind)
{
    return std::any_of(beat.wants.begin(), beat.wants.end(),
                       [kind](const Gateway::Wanted &wanted)
                       { return wanted.node == Nobody && wanted.offers == kind; });
}

}  // namespace

void MarkTool(Gateway::Beat &beat)
{
    Add(beat, Tool);
}

bool IsTool(const Gateway::Beat &beat)
{
    return Has(beat, Tool);
}

void MarkReplay(Gateway::Beat &beat)
{
    Add(beat, Replay);
}

bool IsReplay(const Gateway::Beat &beat)
{
    return Has(beat, Replay);
}

void Ask(Gateway::Beat &beat, const TypeQuestion &question)
{
    std::vector<std::uint8_t> bytes;
    Put(question.Node, bytes);
    Put(question.Definition, bytes);
    Put(question.From, bytes);
    Add(beat, Type).states.assign(bytes.begin(), bytes.end());
}

std::vector<TypeQuestion> TypeQuestionsIn(const Gateway::Beat &beat)
{
    std::vector<TypeQuestion> questions;
    for (const Gateway::Wanted &wanted : beat.wants)
    {
        if (wanted.node == Nobody && wanted.offers == Type && wanted.states.size() == TypeBytes)
        {
            std::span<const std::uint8_t> bytes(wanted.states.data(), wanted.states.size());
            TypeQuestion question;
            question.Node = Take<std::uint32_t>(bytes);
            question.Definition = Take<std::uint64_t>(bytes);
            question.From = Take<std::uint32_t>(bytes);
            questions.push_back(question);
        }
    }
    return questions;
}

}  // namespace Rabit::BeatExtensions
