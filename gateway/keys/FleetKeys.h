#pragma once

#include <ctime>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "keys/Access.h"
#include "keys/Certificates.h"
#include "keys/NodeFolders.h"
#include "keys/NodeKeys.h"
#include "keys/SigningRequest.h"

namespace Rabit::Keys
{

// The folder of a fleet: its two authorities in `authority`, and a folder for each node, ready to be copied
// to that node. Holds a lock: at most one FleetKeys changes a folder at a time; the constructor throws for a
// second one. The constructor finishes a renewal that was cut short: the node's old keys stay.
class FleetKeys
{
public:
    // The access that a node needs, and the half of all GUIDs that fits its transport (WantsSmallGuid).
    struct Request
    {
        std::string Node;
        bool SmallGuid = false;
        Keys::Access Access;
    };
    struct Period
    {
        std::time_t Now = 0;
        int Days = 0;
    };

    // Makes the folder and the authorities. Encrypts the private keys of the authorities, unless the
    // passphrase is empty. Throws KeysError, as all functions here.
    static void Init(const std::string &folder, const std::string &fleet, const Period &period,
                     std::string_view passphrase = {});
    // True if the folder has authorities.
    static bool IsFleet(const std::string &folder);

    // `ask` is called before the first signature, if the private keys of the authorities are encrypted.
    explicit FleetKeys(const std::string &folder, AskPassphrase ask = {});

    const std::string &Fleet() const { return _fleet; }
    std::time_t EndsAt() const { return _validity.To; }
    // The nodes that have a folder, in their NaturalOrder.
    std::vector<std::string> Nodes() const;
    // The nodes whose certificates are all revoked.
    std::vector<std::string> Revoked() const;
    std::string FolderOf(const std::string &node) const { return _folder + "/" + node; }
    // The request from which the node's present keys were made.
    Request RequestOf(const std::string &node) const;

    // Makes the folder of a node. With `signing`, a request of that node, the folder has no private key: the
    // node has it.
    void Add(const Request &request, const Period &period, const SigningRequest *signing = nullptr) const;
    // Replaces the node's certificate and permissions by new ones, and its key by a new one or by that of
    // `signing`. Without `signing`, a node whose folder has no private key keeps its key. The old ones stay
    // good to their end, unless they are revoked.
    void Renew(const Request &request, const Period &period, const SigningRequest *signing = nullptr) const;
    // Throws if the certificate that Renew would make has the key of an older one. RevokeOlder would protect
    // nothing then: a thief of the private key uses the new certificate, which is public.
    void CheckNewKey(const std::string &node, const SigningRequest *signing = nullptr) const;
    // RevokeOlder revokes every certificate that was made for the node except its present one, and throws if
    // one of these has the key of the present one. Revoke revokes all, and removes the node's folder. Both
    // write the new list into the folder of each node, and return how many certificates they revoked.
    std::size_t RevokeOlder(const std::string &node, std::time_t now) const;
    std::size_t Revoke(const std::string &node, std::time_t now) const;

private:
    CertificatePtr Authority(const char *name) const;
    EVP_PKEY &AuthorityKey(const char *name) const;
    std::string Place(const std::string &name) const { return _folder + "/authority/" + name; }
    // The files of the certificates that were made for a node, and for all.
    std::vector<std::string> Issued(const std::string &node) const;
    std::vector<std::string> Issued() const;
    void CheckFresh(const std::string &node, const EVP_PKEY &key) const;
    void CheckIsNotKeyOf(const std::vector<std::string> &files, const std::string &node,
                         const EVP_PKEY &key) const;
    // Returns the key, which is fresh, that the node's next certificate will have: that of the request, if
    // there is one, else the node's own; null: the authorities make a new one.
    KeyPtr KeyFor(const std::string &node, const SigningRequest *signing) const;
    unsigned NextNumber(const Request &request) const;
    // Makes the folder with a certificate for that public key; null: with a private key of its own.
    void Make(const std::string &folder, const Request &request, const Period &period,
              EVP_PKEY *publicKey) const;
    std::size_t RevokeFiles(const std::vector<std::string> &files, std::time_t now) const;

    const std::string _folder;
    const AskPassphrase _ask;
    const FleetLock _lock;
    mutable std::map<std::string, KeyPtr> _authorityKeys;  // read when first needed
    std::string _fleet;
    Validity _validity;
};

}  // namespace Rabit::Keys
