#pragma once

#include <ctime>
#include <string>
#include <vector>

#include "keys/Access.h"
#include "keys/NodeKeys.h"

namespace Rabit::Keys
{

// The folder of a fleet: its two authorities in `authority`, and a folder for each node, ready to be copied
// to it. One that changes it keeps others out for so long.
class FleetKeys
{
public:
    // What a node needs; the transport as a configuration names it.
    struct Request
    {
        std::string Node;
        std::string Transport;
        Keys::Access Access;
    };
    struct Period
    {
        std::time_t Now = 0;
        int Days = 0;
    };

    // Makes the folder and the authorities. Throws KeysError, as all here.
    static void Init(const std::string &folder, const std::string &fleet, const Period &period);
    // Whether there are authorities in a folder.
    static bool IsFleet(const std::string &folder);

    explicit FleetKeys(const std::string &folder);
    ~FleetKeys();
    FleetKeys(const FleetKeys &) = delete;
    FleetKeys &operator=(const FleetKeys &) = delete;

    const std::string &Fleet() const { return _fleet; }
    std::time_t EndsAt() const { return _validity.To; }
    // The nodes that have a folder.
    std::vector<std::string> Nodes() const;
    std::string FolderOf(const std::string &node) const { return _folder + "/" + node; }
    // What a node has now.
    Request RequestOf(const std::string &node) const;

    void Add(const Request &request, const Period &period) const;
    // A new key, certificate and permissions in place of those that the node has. The old ones stay good to
    // their end, unless they are revoked.
    void Renew(const Request &request, const Period &period) const;
    // All that were ever made for the node but the one that it has now; or all, and its folder is no more.
    // Each node's folder then says so. Returns how many.
    std::size_t RevokeOlder(const std::string &node, std::time_t now) const;
    std::size_t Revoke(const std::string &node, std::time_t now) const;

private:
    CertificatePtr Authority(const char *name) const;
    KeyPtr AuthorityKey(const char *name) const;
    std::string Place(const std::string &name) const { return _folder + "/authority/" + name; }
    // The certificates that were made for a node, by file.
    std::vector<std::string> Issued(const std::string &node) const;
    unsigned NextNumber(const Request &request) const;
    void Make(const std::string &folder, const Request &request, const Period &period) const;
    std::size_t RevokeFiles(const std::vector<std::string> &files, std::time_t now) const;

    const std::string _folder;
    const int _lock;
    std::string _fleet;
    Validity _validity;
};

}  // namespace Rabit::Keys
