// The folder of a fleet: one folder for the authority, and one for each node, which are replaced as a whole.
#pragma once

#include <string>
#include <vector>

namespace Rabit::Keys
{

// All functions throw KeysError.

// Throws if the folder, of a fleet or of a node, has files of a former format, which was X.509. Nothing reads
// these any more.
void CheckFormat(const std::string &folder);

// Locks the folder of a fleet: at most one program changes it at a time.
class FleetLock
{
public:
    // Throws if the folder has no authority, or keys of a former format, or if somebody else has the lock.
    explicit FleetLock(const std::string &fleet);
    ~FleetLock();
    FleetLock(const FleetLock &) = delete;
    FleetLock &operator=(const FleetLock &) = delete;

private:
    const int _descriptor;
};

void MoveFolder(const std::string &from, const std::string &to);

// Where the new folder of a node is made.
std::string NewFolderOf(const std::string &fleet, const std::string &node);
// Moves the new folder to the place of the node's present one. If that is cut short, FinishReplacements puts
// the present one back.
void ReplaceFolder(const std::string &fleet, const std::string &node);
void FinishReplacements(const std::string &fleet);

// The names of the folders that have a file of that name, sorted, without that of the authority.
std::vector<std::string> FoldersWith(const std::string &fleet, const std::string &file);

}  // namespace Rabit::Keys
