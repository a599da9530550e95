#pragma once

#include <ctime>
#include <string>
#include <vector>

#include "keys/Access.h"
#include "keys/NodeKeys.h"

namespace Rabit::Keys
{

// The folder of a fleet: its two authorities in `authority`, and a folder for each node, ready to be copied
// to that node. Holds a lock: at most one FleetKeys changes a folder at a time; the constructor throws for a
// second one. The constructor finishes a renewal that was cut short: the node's old keys stay.
class FleetKeys
{
public:
    // The access that a node needs, and the transport as a configuration names it.
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

    // Makes the folder and the authorities. Throws KeysError, as all functions here.
    static void Init(const std::string &folder, const std::string &fleet, const Period &period);
    // True if the folder has authorities.
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
    // The request from which the node's present keys were made.
    Request RequestOf(const std::string &node) const;

    void Add(const Request &request, const Period &period) const;
    // Replaces the node's key, certificate and permissions by new ones. The old ones stay good to their end,
    // unless they are revoked.
    void Renew(const Request &request, const Period &period) const;
    // RevokeOlder revokes every certificate that was made for the node except its present one. Revoke revokes
    // all, and removes the node's folder. Both write the new list into the folder of each node, and return
    // how many certificates they revoked.
    std::size_t RevokeOlder(const std::string &node, std::time_t now) const;
    std::size_t Revoke(const std::string &node, std::time_t now) const;

private:
    CertificatePtr Authority(const char *name) const;
    KeyPtr AuthorityKey(const char *name) const;
    std::string Place(const std::string &name) const { return _folder + "/authority/" + name; }
    // The files of the certificates that were made for a node.
    std::vector<std::string> Issued(const std::string &node) const;
    unsigned NextNumber(const Request &request) const;
    // The place of a node's folder while a new one replaces it.
    std::string OldOf(const std::string &node) const;
    void FinishRenewals() const;
    void Make(const std::string &folder, const Request &request, const Period &period) const;
    std::size_t RevokeFiles(const std::vector<std::string> &files, std::time_t now) const;

    const std::string _folder;
    const int _lock;
    std::string _fleet;
    Validity _validity;
};

}  // namespace Rabit::Keys
