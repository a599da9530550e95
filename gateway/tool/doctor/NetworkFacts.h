#pragma once

#include <map>
#include <set>
#include <string>

namespace Rabit::Tool::Doctor
{

// Who announced itself by multicast from one address.
struct Voices
{
    std::set<std::string> Names;
    bool AreNodes = false;  // one of them at least is a node of Rabit
    std::set<std::string> WithKeys{};  // those of them that take part in DDS Security
};

// What was tried on one interface, and came of it.
struct MulticastTrial
{
    std::string Error;              // why nothing could be sent; empty: it was
    std::set<std::string> HeardOn;  // interfaces of this machine on which it came in
    std::set<std::string>
        HeardFrom;  // addresses of participants that announced themselves on it by multicast
    std::set<std::string> AnsweredFrom;  // and of those that answered what was announced on it by multicast
};

struct NetworkFacts
{
    std::map<std::string, MulticastTrial> Trials;          // by interface
    std::map<int, std::map<std::string, Voices>> Domains;  // by address
};

}  // namespace Rabit::Tool::Doctor
