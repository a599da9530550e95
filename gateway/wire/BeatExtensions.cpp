#include "wire/BeatExtensions.h"

#include <rabit/base/LittleEndian.h>

#include <algorithm>
#include <span>

#include "wire/BeatNews.h"

namespace Rabit::BeatExtensions
{

using LittleEndian::Put;
using LittleEndian::Take;

namespace
{

Gateway::Wanted &Add(Gateway::Beat &beat, std::uint16_t kind)
{
    Gateway::Wanted &extension = NewsOf(beat).wants.emplace_back();
    extension.node = Nobody;
    extension.offers = kind;
    return extension;
}

// The bytes of an extension, if there are at least as many; empty: the beat has none.
std::optional<std::span<const std::uint8_t>> Find(const Gateway::Beat &beat, std::uint16_t kind,
                                                  std::size_t least)
{
    const auto &wants = NewsOf(beat).wants;
    const auto found = std::find_if(
        wants.begin(), wants.end(),
        [&](const Gateway::Wanted &wanted)
        { return wanted.node == Nobody && wanted.offers == kind && wanted.states.size() >= least; });
    return found == wants.end() ? std::nullopt
                                : std::optional(std::span(found->states.data(), found->states.size()));
}

}  // namespace

void MarkTool(Gateway::Beat &beat)
{
    Add(beat, Tool);
}

bool IsTool(const Gateway::Beat &beat)
{
    return Find(beat, Tool, 0).has_value();
}

void MarkReplay(Gateway::Beat &beat)
{
    Add(beat, Replay);
}

bool IsReplay(const Gateway::Beat &beat)
{
    return Find(beat, Replay, 0).has_value();
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
    for (const Gateway::Wanted &wanted : NewsOf(beat).wants)
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

void Say(Gateway::Beat &beat, std::span<const LinkStrain> strains)
{
    std::vector<std::uint8_t> bytes;
    for (const LinkStrain &strain : strains.first(std::min(strains.size(), MostStrains)))
    {
        Put(strain.Node, bytes);
        Put(static_cast<std::uint8_t>(strain.What), bytes);
        Put(strain.Percent, bytes);
        Put(strain.Messages, bytes);
    }
    Add(beat, Strain).states.assign(bytes.begin(), bytes.end());
}

std::vector<LinkStrain> StrainsIn(const Gateway::Beat &beat)
{
    std::vector<LinkStrain> strains;
    for (const Gateway::Wanted &wanted : NewsOf(beat).wants)
    {
        if (wanted.node != Nobody || wanted.offers != Strain)
        {
            continue;
        }
        std::span<const std::uint8_t> bytes(wanted.states.data(), wanted.states.size());
        while (bytes.size() >= StrainBytes && strains.size() < MostStrains)
        {
            LinkStrain strain;
            strain.Node = Take<std::uint32_t>(bytes);
            strain.What = static_cast<LinkStrain::Kind>(Take<std::uint8_t>(bytes));
            strain.Percent = std::min<std::uint8_t>(Take<std::uint8_t>(bytes), 100);
            strain.Messages = Take<std::uint16_t>(bytes);
            if (strain.What >= LinkStrain::Kind::Filling && strain.What <= LinkStrain::Kind::HeldBack)
            {
                strains.push_back(strain);
            }
        }
    }
    return strains;
}

void Say(Gateway::Beat &beat, const ProblemCount &problems)
{
    std::vector<std::uint8_t> bytes;
    Put(problems.Count, bytes);
    Put(problems.Digest, bytes);
    Add(beat, Problems).states.assign(bytes.begin(), bytes.end());
}

std::size_t SayFirstHeard(Gateway::Beat &beat, std::span<const std::uint32_t> tags, std::size_t from)
{
    const std::size_t count = std::min(tags.size(), MostFirstHeard);
    const std::size_t first = tags.size() > count ? from % tags.size() : 0;
    std::vector<std::uint8_t> bytes;
    for (std::size_t i = 0; i < count; ++i)
    {
        Put(tags[(first + i) % tags.size()], bytes);
    }
    Add(beat, FirstHeardHere).states.assign(bytes.begin(), bytes.end());
    return first + count - 1;  // the windows overlap, so that none is between two of them
}

std::optional<bool> IsFirstHeardHere(const Gateway::Beat &beat, std::uint32_t tag)
{
    for (const Gateway::Wanted &wanted : NewsOf(beat).wants)
    {
        if (wanted.node != Nobody || wanted.offers != FirstHeardHere)
        {
            continue;
        }
        std::vector<std::uint32_t> tags;
        std::span<const std::uint8_t> bytes(wanted.states.data(), wanted.states.size());
        while (bytes.size() >= sizeof(tag))
        {
            tags.push_back(Take<std::uint32_t>(bytes));
        }
        if (std::find(tags.begin(), tags.end(), tag) != tags.end())
        {
            return true;
        }
        const bool isWindow = tags.size() >= MostFirstHeard;
        const bool isAbove = isWindow && tag > tags.front();
        const bool isBelow = isWindow && tag < tags.back();
        const bool isInside =
            isWindow && tags.front() > tags.back() ? isAbove || isBelow : isAbove && isBelow;
        return !isWindow || isInside ? std::optional(false) : std::nullopt;
    }
    return false;
}

void SayFleetSum(Gateway::Beat &beat, std::uint32_t sum)
{
    std::vector<std::uint8_t> bytes;
    Put(sum, bytes);
    Add(beat, FleetSum).states.assign(bytes.begin(), bytes.end());
}

std::optional<std::uint32_t> FleetSumIn(const Gateway::Beat &beat)
{
    std::optional<std::span<const std::uint8_t>> bytes = Find(beat, FleetSum, sizeof(std::uint32_t));
    return bytes ? std::optional(Take<std::uint32_t>(*bytes)) : std::nullopt;
}

void Say(Gateway::Beat &beat, const AgreementNews &agreement)
{
    std::vector<std::uint8_t> bytes;
    Put(agreement.Group, bytes);
    Put(agreement.Table, bytes);
    bytes.insert(bytes.end(), agreement.Renewal.begin(), agreement.Renewal.end());
    Add(beat, Agreement).states.assign(bytes.begin(), bytes.end());
    std::span<const std::uint8_t> answers(agreement.Answers);
    while (!answers.empty())
    {
        const auto some = answers.first(std::min(answers.size(), AgreementNews::AnswersOfOne));
        answers = answers.subspan(some.size());
        Add(beat, AgreementAnswers).states.assign(some.begin(), some.end());
    }
}

std::optional<AgreementNews> AgreementIn(const Gateway::Beat &beat)
{
    std::optional<std::span<const std::uint8_t>> bytes = Find(beat, Agreement, AgreementLeast);
    if (!bytes)
    {
        return std::nullopt;
    }
    AgreementNews agreement;
    agreement.Group = Take<std::uint32_t>(*bytes);
    agreement.Table = Take<std::uint64_t>(*bytes);
    agreement.Renewal.assign(bytes->begin(), bytes->end());
    for (const Gateway::Wanted &wanted : NewsOf(beat).wants)
    {
        const bool isOfAnswers = wanted.node == Nobody && wanted.offers == AgreementAnswers;
        if (isOfAnswers && agreement.Answers.size() + wanted.states.size() <= AgreementNews::MostAnswers)
        {
            agreement.Answers.insert(agreement.Answers.end(), wanted.states.begin(), wanted.states.end());
        }
    }
    return agreement;
}

std::optional<ProblemCount> ProblemsIn(const Gateway::Beat &beat)
{
    std::optional<std::span<const std::uint8_t>> bytes = Find(beat, Problems, ProblemBytes);
    if (!bytes)
    {
        return std::nullopt;
    }
    ProblemCount problems;
    problems.Count = Take<std::uint16_t>(*bytes);
    problems.Digest = Take<std::uint32_t>(*bytes);
    return problems;
}

}  // namespace Rabit::BeatExtensions
