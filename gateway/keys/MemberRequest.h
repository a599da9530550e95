#pragma once

#include <string>
#include <string_view>

#include "keys/MemberSecrets.h"

namespace Rabit::Keys
{

// A node's request for a certificate. The node signs it with its private key, which stays on the node. It has
// the node's name and public keys, and nothing else; the authority decides on number, dates and permissions.
// Numbers are little-endian:
//
//   offset  size  what
//   0       1     format, 1
//   1       32    Ed25519 public key
//   33      32    X25519 public key
//   65      1     length of the name, 1 to 64
//   66      n     the name
//   ...     64    Ed25519 signature by the first key over "Rabit request 1" and all before
struct MemberRequest
{
    std::string Node;
    MemberPublic Keys;
};

// Returns the armoured request. Throws KeysError.
std::string MakeMemberRequest(const std::string &node, const MemberSecrets &secrets);

// Reads a request that anybody may have written, of up to 16 KiB. Verifies its signature, its name and its
// keys. Throws KeysError, which names `file`.
MemberRequest ReadMemberRequest(std::string_view text, const std::string &file);

// Makes the private keys in the folder of a node, unless the folder has some, and writes a request for them
// to `<folder>/<node>.request.pem`. Makes the folder unless it exists. Throws KeysError.
struct RequestedMember
{
    std::string File;
    std::string Fingerprint;
};
RequestedMember RequestMember(const std::string &folder, const std::string &node);

}  // namespace Rabit::Keys
