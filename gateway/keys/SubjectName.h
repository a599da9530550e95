#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "keys/OpenSsl.h"

namespace Rabit::Keys
{

// Who a certificate is for: a node of a fleet. DDS derives the beginning of a participant's GUID from it (OMG
// DDS Security 1.1, 9.3.3), so that nobody can take a GUID that is not his. The number is one of several, of
// which some make a GUID that is large and others one that is small: two vendors only find together if the
// one that begins has the smaller.
struct SubjectName
{
    static constexpr unsigned LargestNumber = 255;

    std::string Fleet;
    unsigned Number = 0;
    std::string Node;

    // As permissions name it (RFC 2253): `CN=uav1,OU=2,O=blue`.
    std::string Text() const;
    NamePtr Encoded() const;
    bool operator==(const SubjectName &) const = default;
};

// Of a certificate that such a name was put into. Throws KeysError if it is none.
SubjectName SubjectOf(const X509 &certificate);

// How the GUIDs of its participants begin.
std::array<std::uint8_t, 6> GuidStartOf(const X509_NAME &name);

// Whether those of a node of a vendor begin with the smaller half of all GUIDs: a participant of Cyclone DDS
// cannot answer one of Fast DDS that begins, and the smaller one begins.
bool WantsSmallGuid(std::string_view transport);
bool HasSmallGuid(const SubjectName &subject);

// Whether a participant whose GUID begins so has the certificate of that node, with whatever number.
bool IsGuidOf(const std::string &fleet, std::string_view node, std::span<const std::uint8_t, 12> guidPrefix);

}  // namespace Rabit::Keys
