#include "keys/NodeFolders.h"

#include <fcntl.h>
#include <rabit/base/NaturalOrder.h>
#include <rabit/keys/KeysError.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "keys/NodeName.h"

namespace Rabit::Keys
{
namespace
{

constexpr const char *OldFolderEnding = ".old";

int LockedFolder(const std::string &fleet)
{
    CheckFormat(fleet);
    const int lock = ::open((fleet + "/" + AuthorityFolder).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (lock < 0)
    {
        throw KeysError("there is no authority of a fleet in " + fleet + "; `rabit keys init " + fleet +
                        "` makes one");
    }
    if (::flock(lock, LOCK_EX | LOCK_NB) != 0)
    {
        ::close(lock);
        throw KeysError("somebody else is changing the keys in " + fleet + " now");
    }
    return lock;
}

std::string FormerFolderOf(const std::string &fleet, const std::string &node)
{
    return fleet + "/." + node + OldFolderEnding;
}

}  // namespace

void CheckFormat(const std::string &folder)
{
    for (const std::string file : {"/authority/identity.pem", "/certificate.pem", "/private_key.pem"})
    {
        if (std::filesystem::exists(folder + file))
        {
            throw KeysError(folder +
                            " has keys of a former format, which nothing reads any more; make a new fleet in "
                            "another folder with `rabit keys init`, and its nodes with `rabit keys add`");
        }
    }
}

FleetLock::FleetLock(const std::string &fleet) : _descriptor(LockedFolder(fleet)) {}

FleetLock::~FleetLock()
{
    ::close(_descriptor);
}

void MoveFolder(const std::string &from, const std::string &to)
{
    std::error_code error;
    std::filesystem::rename(from, to, error);
    if (error)
    {
        throw KeysError("cannot rename " + from + " to " + to + ": " + error.message());
    }
}

std::string NewFolderOf(const std::string &fleet, const std::string &node)
{
    return fleet + "/." + node + ".new";
}

void ReplaceFolder(const std::string &fleet, const std::string &node)
{
    const std::string folder = fleet + "/" + node;
    const std::string former = FormerFolderOf(fleet, node);
    std::error_code ignored;
    std::filesystem::remove_all(former, ignored);
    MoveFolder(folder, former);
    MoveFolder(NewFolderOf(fleet, node), folder);
    std::filesystem::remove_all(former, ignored);
}

void FinishReplacements(const std::string &fleet)
{
    std::vector<std::string> left;
    for (const auto &entry : std::filesystem::directory_iterator(fleet))
    {
        const std::string name = entry.path().stem().string();
        const std::string node = name.starts_with('.') ? name.substr(1) : "";
        if (entry.path().extension() == OldFolderEnding && IsFolderName(node) && node != AuthorityFolder)
        {
            left.push_back(node);
        }
    }
    for (const std::string &node : left)
    {
        if (!std::filesystem::exists(fleet + "/" + node))
        {
            MoveFolder(FormerFolderOf(fleet, node), fleet + "/" + node);
        }
        else
        {
            std::error_code ignored;
            std::filesystem::remove_all(FormerFolderOf(fleet, node), ignored);
        }
    }
}

std::vector<std::string> FoldersWith(const std::string &fleet, const std::string &file)
{
    std::vector<std::string> nodes;
    for (const auto &entry : std::filesystem::directory_iterator(fleet))
    {
        const std::string name = entry.path().filename().string();
        if (entry.is_directory() && name != AuthorityFolder && IsFolderName(name) &&
            std::filesystem::exists(entry.path() / file))
        {
            nodes.push_back(name);
        }
    }
    std::sort(nodes.begin(), nodes.end(), NaturalOrder());
    return nodes;
}

}  // namespace Rabit::Keys
