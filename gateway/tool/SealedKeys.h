// The commands of `rabit keys` for fleets whose keys have the new format (gateway/keys/README.md).
#pragma once

#include <string>

#include "KeysOptions.h"

namespace Rabit::Tool::SealedKeys
{

// True if the folder is one of a fleet, or of a node, with keys of that format.
bool AreIn(const std::string &folder);

// Each returns the exit code. All throw KeysError and ConfigError.
int Init(const KeysOptions &options);
int Add(const KeysOptions &options);
int Request(const KeysOptions &options);
int Sign(const KeysOptions &options);
int Renew(const KeysOptions &options);
int Revoke(const KeysOptions &options);
int Check(const KeysCheckOptions &options);

}  // namespace Rabit::Tool::SealedKeys
