// Private keys as text: PKCS #8 in PEM (RFC 7468).
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "keys/OpenSsl.h"
#include "keys/Secret.h"

namespace Rabit::Keys
{

// Returns the passphrase of an encrypted private key in `file`; may throw KeysError.
using AskPassphrase = std::function<Secret(const std::string &file)>;

// Encrypts the key (scrypt and AES-256) unless the passphrase is empty.
std::string PemOf(const EVP_PKEY &key, std::string_view passphrase = {});

// Reads the first private key of the text. Throws KeysError, which names `file`. Without `ask`, an encrypted
// key is refused: at the start of a node no person is there to type.
KeyPtr ReadKey(std::string_view pem, const std::string &file, const AskPassphrase &ask = {});

}  // namespace Rabit::Keys
