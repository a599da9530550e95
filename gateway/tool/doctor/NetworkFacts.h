#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>

namespace Rabit::Tool::Doctor
{

// The participants that were heard by multicast from one address.
struct Voices
{
    std::set<std::string> Names;               // LabelOf each that announced itself
    bool AreNodes = false;                     // at least one of these is a node of Rabit
    std::set<std::uint32_t> SealedSessions{};  // the tags of sessions with keys, whose names are not known
};

// The result of sending by multicast on one interface.
struct MulticastTrial
{
    std::string Error;              // why nothing could be sent; empty: sent
    std::set<std::string> HeardOn;  // interfaces of this machine on which it came in
    // Addresses of participants of the configured domain that announced themselves on it by multicast.
    std::set<std::string> HeardFrom;
    std::set<std::string> AnsweredFrom;  // those that answered an announcement sent on it
};

struct NetworkFacts
{
    std::map<std::string, MulticastTrial> Trials;          // by interface
    std::map<int, std::map<std::string, Voices>> Domains;  // by address
    // Participants that were heard only on interfaces that are not used: their addresses, by domain and
    // interface.
    std::map<int, std::map<std::string, std::set<std::string>>> Elsewhere{};
    // Participants of the configured domain on this machine that answered only at its loopback address:
    // LabelOf each. They neither hear nor send multicast. Never nodes of Rabit.
    std::set<std::string> OnLoopbackAlone{};
};

}  // namespace Rabit::Tool::Doctor
