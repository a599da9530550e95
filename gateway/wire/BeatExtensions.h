#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "gateway.idl.h"
#include "wire/AgreementNews.h"
#include "wire/LinkStrain.h"
#include "wire/ProblemCount.h"

// Extensions of beats that the first gateways of this format do not know: entries of Beat::wants for a node
// tag that no node has. These gateways ignore them, so that both kinds understand each other.
namespace Rabit::BeatExtensions
{

// Wanted::node of an extension, and Wanted::offers, which says which one it is.
inline constexpr std::uint32_t Nobody = 0;  // NodeTagOf never gives it
inline constexpr std::uint16_t Tool = 1;    // the sender is a tool (ToolSettings)
inline constexpr std::uint16_t Type = 2;    // a TypeQuestion, in Wanted::states
inline constexpr std::uint16_t Replay = 3;  // the sender plays a recording (GatewayConfig::Replay)
inline constexpr std::uint16_t Strain = 4;  // LinkStrains of the sender, in Wanted::states
inline constexpr std::uint16_t Problems =
    5;  // ProblemCount of the sender, in Wanted::states; none: no problem

// The tags of nodes that the sender hears by this path and by no better one (gateway/paths), in
// Wanted::states.
inline constexpr std::uint16_t FirstHeardHere = 6;

// The sum of the tags of the sender and of all nodes that it hears, in Wanted::states; said when a tool has
// come. A tool that hears nodes with the same sum has heard the whole fleet.
inline constexpr std::uint16_t FleetSum = 7;

// What the sender tells of its agreement, in Wanted::states: group (4), digest of the table (8), and the
// renewal of its lease (0 or 8).
inline constexpr std::uint16_t Agreement = 8;
// Answers to renewals of others (AgreementNode::Beat), in Wanted::states; some of them if there are several
// extensions.
inline constexpr std::uint16_t AgreementAnswers = 9;

// Bytes of Wanted::states.
inline constexpr std::size_t TypeBytes = 16;
inline constexpr std::size_t StrainBytes = 8;  // of each
inline constexpr std::size_t ProblemBytes = 6;
inline constexpr std::size_t AgreementLeast = 12;
// Most strains that are read from one beat.
inline constexpr std::size_t MostStrains = 4;
// Most tags in FirstHeardHere. A beat with as many says nothing of the tags outside of its window.
inline constexpr std::size_t MostFirstHeard = 32;

// The sender lacks the text of a type that a node has announced.
struct TypeQuestion
{
    std::uint32_t Node = 0;        // tag of the asked node
    std::uint64_t Definition = 0;  // as in the announcement
    std::uint32_t From = 0;        // the first byte that is lacking

    bool operator==(const TypeQuestion &) const = default;
};

void MarkTool(Gateway::Beat &beat);
bool IsTool(const Gateway::Beat &beat);

void MarkReplay(Gateway::Beat &beat);
bool IsReplay(const Gateway::Beat &beat);

void Ask(Gateway::Beat &beat, const TypeQuestion &question);
// The questions in a beat; malformed ones are left out.
std::vector<TypeQuestion> TypeQuestionsIn(const Gateway::Beat &beat);

// The first MostStrains of them.
void Say(Gateway::Beat &beat, std::span<const LinkStrain> strains);
// The strains in a beat; malformed ones and unknown kinds are left out.
std::vector<LinkStrain> StrainsIn(const Gateway::Beat &beat);

// The sender's own problems, as its log tells them (report/ProblemLog.h).
void Say(Gateway::Beat &beat, const ProblemCount &problems);
// Empty if the beat does not tell.
std::optional<ProblemCount> ProblemsIn(const Gateway::Beat &beat);

// `tags` are sorted and different. If there are more than MostFirstHeard, the beat has those from the one at
// `from` on, and the first one comes after the last. Returns `from` for the next beat.
std::size_t SayFirstHeard(Gateway::Beat &beat, std::span<const std::uint32_t> tags, std::size_t from);
// Empty if the beat does not tell.
std::optional<bool> IsFirstHeardHere(const Gateway::Beat &beat, std::uint32_t tag);

void SayFleetSum(Gateway::Beat &beat, std::uint32_t sum);
// Empty if the beat does not tell.
std::optional<std::uint32_t> FleetSumIn(const Gateway::Beat &beat);

void Say(Gateway::Beat &beat, const AgreementNews &agreement);
// Empty if the sender has no agreement.
std::optional<AgreementNews> AgreementIn(const Gateway::Beat &beat);

}  // namespace Rabit::BeatExtensions
