// Faults of sealing and opening as text for people.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "common/Rtps.h"
#include "envelope/LastingProblems.h"
#include "envelope/NodeVoices.h"
#include "envelope/Opener.h"
#include "envelope/Sealer.h"

namespace Rabit::Envelope
{

const char *TextOf(SealFault fault);
// A row for people, if the fault lasts.
struct FaultRow
{
    std::string Entry;  // the sender's name or address
    std::string Text;   // empty if nothing is wrong with the sender
    ProblemKind Kind = ProblemKind::Usual;
};
// `in`: the epoch that the datagram names; `newest`: the newest one here.
FaultRow RowOf(const Opener::Result &result, std::span<const std::uint8_t> datagram, Epoch in, Epoch newest,
               const Rtps::HostAddress &from);
// A node lives twice.
std::string TextOf(NodeVoices::Verdict verdict, const std::string &name);

}  // namespace Rabit::Envelope
