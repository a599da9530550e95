#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "gateway.idl.h"
#include "wire/LinkStrain.h"

// What beats say that the first gateways of their format do not know: entries of Beat::wants for a node whose
// tag nobody has. Those pass over them, so that gateways of both kinds go on understanding each other.
namespace Rabit::BeatExtensions
{

// Wanted::node of an extension, and Wanted::offers, which says which one it is.
inline constexpr std::uint32_t Nobody = 0;  // NodeTagOf never gives it
inline constexpr std::uint16_t Tool = 1;    // the sender is a tool (ToolSettings)
inline constexpr std::uint16_t Type = 2;    // a TypeQuestion, in Wanted::states
inline constexpr std::uint16_t Replay =
    3;  // what the sender posts was recorded before (GatewayConfig::Replay)
inline constexpr std::uint16_t Strain = 4;  // LinkStrains of the sender, in Wanted::states

// Bytes of Wanted::states.
inline constexpr std::size_t ToolBytes = 0;
inline constexpr std::size_t ReplayBytes = 0;
inline constexpr std::size_t TypeBytes = 16;
inline constexpr std::size_t StrainBytes = 8;  // of each
// So many are taken of one beat at most.
inline constexpr std::size_t MostStrains = 4;

// The sender lacks the text of a type that a node has announced.
struct TypeQuestion
{
    std::uint32_t Node = 0;        // tag of who is asked
    std::uint64_t Definition = 0;  // as in the announcement
    std::uint32_t From = 0;        // the first byte that is lacking

    bool operator==(const TypeQuestion &) const = default;
};

void MarkTool(Gateway::Beat &beat);
bool IsTool(const Gateway::Beat &beat);

void MarkReplay(Gateway::Beat &beat);
bool IsReplay(const Gateway::Beat &beat);

void Ask(Gateway::Beat &beat, const TypeQuestion &question);
// The questions in a beat; what makes no sense is left out.
std::vector<TypeQuestion> TypeQuestionsIn(const Gateway::Beat &beat);

// The first MostStrains of them.
void Say(Gateway::Beat &beat, std::span<const LinkStrain> strains);
// The strains in a beat; kinds that are not known here, and what makes no sense, are left out.
std::vector<LinkStrain> StrainsIn(const Gateway::Beat &beat);

}  // namespace Rabit::BeatExtensions
