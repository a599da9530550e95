#pragma once

#include <optional>
#include <string>

#include "keys/PrivateKeyPem.h"

namespace Rabit::Keys
{

// Returns the passphrase in `file`, or, if that is empty, in RABIT_KEYS_PASSPHRASE of the environment; none
// if neither is given. The command line has no passphrase: other users of the machine can read it. Throws
// KeysError.
std::optional<Secret> GivenPassphrase(const std::string &file);

// Asks for a passphrase at the terminal, without showing it; `isNew`: twice. Throws KeysError.
Secret TypedPassphrase(const std::string &prompt, bool isNew);

// Returns the given passphrase or else the typed one, and asks once only.
AskPassphrase PassphraseFrom(const std::string &file);

}  // namespace Rabit::Keys
