// Makes keys as the program `rabit` would not, for strangers_test.py:
//   odd_keys init <folder> <fleet>
//   odd_keys add <folder> <node> <transport> <domain> <begins in days> <days> [<name> [<topic>]]
//                                     for the topic State, in the partition of this name instead of its own;
//                                     the node may write <topic> instead
//   odd_keys revoke <folder> <node>                      the node's folder stays
//   odd_keys sign_with_identity <folder> <node>          its permissions, by the wrong authority
#include <ctime>
#include <exception>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include "keys/FleetKeys.h"
#include "keys/KeyFiles.h"
#include "keys/SignedDocument.h"
#include "keys/SubjectName.h"

namespace
{

using namespace Rabit::Keys;

constexpr std::time_t Day = 24 * 60 * 60;

void Add(const std::vector<std::string> &words)
{
    const std::string &node = words.at(2);
    const std::string partition = words.size() > 7 ? words[7] : node;
    const Access access{.Domain = std::stoi(words.at(4)),
                        .Publish = {{words.size() > 8 ? words[8] : "State", {"", partition}}},
                        .Subscribe = {{"State", {"*"}}}};
    FleetKeys(words.at(1))
        .Add({.Node = node, .SmallGuid = WantsSmallGuid(words.at(3)), .Access = access},
             {.Now = std::time(nullptr) + static_cast<std::time_t>(std::stod(words.at(5)) * Day),
              .Days = std::stoi(words.at(6))});
}

void Revoke(const std::string &folder, const std::string &node)
{
    const FleetKeys fleet(folder);
    const std::string kept = folder + "/." + node + ".kept";
    std::filesystem::copy(fleet.FolderOf(node), kept);
    fleet.Revoke(node, std::time(nullptr));
    std::filesystem::rename(kept, fleet.FolderOf(node));
}

void SignWithIdentity(const std::string &folder, const std::string &node)
{
    const std::string place = folder + "/authority/";
    const CertificatePtr wrong = ReadCertificate(ReadFile(place + "identity.pem"), "identity.pem");
    const CertificatePtr right = ReadCertificate(ReadFile(place + "permissions.pem"), "permissions.pem");
    const KeyPtr key = ReadKey(ReadSecret(place + "identity_key.pem"), "identity_key.pem");
    const std::string file = NodeFiles(folder + "/" + node).Permissions;
    WriteFile(file, SignDocument(VerifiedDocument(ReadFile(file), *right, file), *wrong, *key));
}

void Run(const std::vector<std::string> &words)
{
    const std::string &command = words.at(0);
    if (command == "init")
    {
        constexpr int longTime = 3650;
        FleetKeys::Init(words.at(1), words.at(2), {.Now = std::time(nullptr), .Days = longTime});
    }
    else if (command == "add")
    {
        Add(words);
    }
    else if (command == "revoke")
    {
        Revoke(words.at(1), words.at(2));
    }
    else if (command == "sign_with_identity")
    {
        SignWithIdentity(words.at(1), words.at(2));
    }
    else
    {
        throw std::runtime_error("no such command: " + command);
    }
}

}  // namespace

int main(int argc, char **argv)
{
    try
    {
        Run({argv + 1, argv + argc});
        return 0;
    }
    catch (const std::exception &error)
    {
        std::cerr << error.what() << '\n';
        return 1;
    }
}
