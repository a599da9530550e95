#pragma once

#include <string>
#include <vector>

namespace Rabit::Tool
{

// The options of the commands of `rabit keys` but `check`.
struct KeysOptions
{
    std::string Folder = "keys";
    std::string FleetName = "fleet";
    std::string Node;
    std::vector<std::string> Nodes;
    std::string Config;
    std::vector<std::string> Requests;
    std::string PassphraseFile;
    std::string Transport;
    int Domain = -1;  // the file's, or for a tool that of the fleet
    int Days = 365;
    bool ForTool = false;
    bool RevokeOld = false;
    bool AsksForPassphrase = false;
    bool Sealed = false;
    bool Json = false;
};

struct KeysCheckOptions
{
    std::string Folder = "keys";
    std::vector<std::string> Configs;
    int Ahead = 30;
    bool Json = false;
};

}  // namespace Rabit::Tool
