#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "keys/NodeName.h"
#include "keys/OpenSsl.h"

namespace Rabit::Keys
{

// The subject of a certificate: a node of a fleet. DDS derives the beginning of a participant's GUID from it
// (OMG DDS Security 1.1, 9.3.3), so that nobody can take the GUID of another node. Some numbers lead to a
// large GUID, others to a small one. Cyclone DDS and Fast DDS only find each other if the GUID of Cyclone DDS
// is the smaller one (WantsSmallGuid).
struct SubjectName
{
    static constexpr unsigned LargestNumber = 255;

    std::string Fleet;
    unsigned Number = 0;
    std::string Node;

    // The form in permissions (RFC 2253): `CN=uav1,OU=2,O=blue`.
    std::string Text() const;
    NamePtr Encoded() const;
    bool operator==(const SubjectName &) const = default;
};

// Returns the subject of a certificate. Throws KeysError if it is not of that form.
SubjectName SubjectOf(const X509 &certificate);

// Returns the first bytes of the GUIDs of the node's participants.
std::array<std::uint8_t, 6> GuidStartOf(const X509_NAME &name);

// True if GUIDs of nodes of that transport begin with the smaller half of all GUIDs. The participant with the
// smaller GUID begins the handshake, and Cyclone DDS cannot answer a handshake that Fast DDS begins.
bool WantsSmallGuid(std::string_view transport);
bool HasSmallGuid(const SubjectName &subject);

// True if a participant whose GUID begins this way has the certificate of that node, with any number.
bool IsGuidOf(const std::string &fleet, std::string_view node, std::span<const std::uint8_t, 12> guidPrefix);

}  // namespace Rabit::Keys
