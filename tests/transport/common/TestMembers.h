// A fleet with keys, made in memory. Link rabit_transport_seal.
#pragma once

#include <rabit/transport/FleetMember.h>

#include <memory>
#include <stdexcept>
#include <string>

#include "envelope/Certificate.h"
#include "envelope/NamedKeys.h"

namespace Rabit::Conformance
{

// The authority of one fleet, and its members. Not thread-safe.
class TestMembers : public Envelope::NamedKeys
{
public:
    using NamedKeys::NamedKeys;

    // A new member, as a process with this node's keys has one. `rules`: what it may write and read.
    std::shared_ptr<FleetMember> Member(const std::string &node, const Rules &rules = Everything(),
                                        Envelope::CertificateRole role = Envelope::CertificateRole::Node)
    {
        auto made = MakeFleetMember(KeysOf(node, rules, role));
        if (made.Member == nullptr)
        {
            throw std::runtime_error(made.Error);
        }
        return made.Member;
    }
};

}  // namespace Rabit::Conformance
