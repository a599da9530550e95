#pragma once

#include <string>
#include <string_view>

#include "keys/OpenSsl.h"

namespace Rabit::Keys
{

// A node's request for a certificate (PKCS #10). The node signs it with its private key, which stays on the
// node. It names the node and nothing else; the authorities decide on fleet, number, dates and permissions.
struct SigningRequest
{
    std::string Node;
    KeyPtr PublicKey;
};

// Makes a request. Returns it as PEM.
std::string MakeSigningRequest(const std::string &node, EVP_PKEY &privateKey);

// Reads a request that anybody may have written, of up to 16 KiB. Verifies its signature, the name, and that
// the key is on the curve P-256. Ignores extensions. Throws KeysError, which names `file`.
SigningRequest ReadSigningRequest(std::string_view pem, const std::string &file);

// Returns the SHA-256 hash of a public key, in hex digits, for people to compare.
std::string FingerprintOf(const EVP_PKEY &key);

// Makes the private key in the folder of a node, unless the folder has one, and writes a request for it to
// `<folder>/<node>.request.pem`. Makes the folder unless it exists. Throws KeysError.
struct RequestedKeys
{
    std::string File;
    std::string Fingerprint;
};
RequestedKeys RequestKeys(const std::string &folder, const std::string &node);

}  // namespace Rabit::Keys
