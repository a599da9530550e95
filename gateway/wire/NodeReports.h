#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

// Texts that a node writes about itself when another one requests them. Requests and answers are those for
// types (BeatExtensions::TypeQuestion, TypeFrames), with the name of a report in place of a type's hash.
// Gateways that do not know a report do not answer.
namespace Rabit::NodeReports
{

enum class Kind : std::uint8_t
{
    Problems = 1,   // digest of its problems, and a line for each of the first ones
    Air = 2,        // its Gateway::AirStatus, as decimal numbers
    LastLines = 3,  // the last lines of its log; the argument is their number
    LinesFrom = 4,  // lines of its log; the argument is the number of the first one, modulo 2^32
    Echo = 5,       // nothing: for the round trip; the argument tells one request from another
    Foreign = 6,    // its topics of foreign programs (ForeignReport)
    Agreement = 7   // the members of its agreement, and the claims that it holds (AgreementReport)
};

// A report, as TypeQuestion::Definition. A type's hash has this form once in 2^24.
constexpr std::uint64_t NameOf(Kind kind, std::uint32_t argument = 0)
{
    return std::uint64_t{0x526570} << 40 | std::uint64_t{static_cast<std::uint8_t>(kind)} << 32 | argument;
}

struct Name
{
    Kind What = Kind::Problems;
    std::uint32_t Argument = 0;
};
// Empty if the number names no known report.
constexpr std::optional<Name> NameIn(std::uint64_t definition)
{
    const auto kind = static_cast<Kind>(static_cast<std::uint8_t>(definition >> 32));
    const auto argument = static_cast<std::uint32_t>(definition);
    const bool isKnown =
        kind >= Kind::Problems && kind <= Kind::Agreement && NameOf(kind, argument) == definition;
    return isKnown ? std::optional(Name{kind, argument}) : std::nullopt;
}

// Largest report in bytes.
inline constexpr std::size_t Largest = 32 * 1024;

// A report as it is sent: with its hash before it, so that parts of two versions are not taken for one
// report.
std::string Sealed(std::string_view report);
// Empty if the text is no whole report.
std::optional<std::string> Opened(std::string_view text);

}  // namespace Rabit::NodeReports
