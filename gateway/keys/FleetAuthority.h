#pragma once

#include <cstddef>
#include <ctime>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "envelope/AgreementKey.h"
#include "envelope/Certificate.h"
#include "envelope/Permissions.h"
#include "envelope/SigningKey.h"
#include "keys/BulletinStore.h"
#include "keys/FleetRecords.h"
#include "keys/MemberRequest.h"
#include "keys/MemberSecrets.h"
#include "keys/NodeFolders.h"

namespace Rabit::Keys
{

// The folder of a fleet: its authority in `authority`, and a folder for each node, ready to be copied to that
// node. Holds a lock, and finishes a renewal that was cut short: the node's old keys stay then. All functions
// throw KeysError.
//
// The authority stores no secret but its private key: each bulletin has the secret of its epoch for the
// authority, too, under the serial 0.
class FleetAuthority
{
public:
    struct Request
    {
        std::string Node;
        Envelope::CertificateRole Role = Envelope::CertificateRole::Node;
        Envelope::Permissions Allowed;
    };
    struct Period
    {
        std::time_t Now = 0;
        int Days = 0;
    };

    // Makes the folder, the authority and epoch 1. Encrypts the private key, unless the passphrase is empty.
    static void Init(const std::string &folder, std::string_view passphrase = {});
    // True if the folder has an authority.
    static bool IsIn(const std::string &folder);

    // `ask` is called before the first signature, if the private key of the authority is encrypted.
    explicit FleetAuthority(const std::string &folder, AskPassphrase ask = {});

    // The nodes that have a folder.
    std::vector<std::string> Nodes() const;
    // The nodes whose certificates are all revoked.
    std::vector<std::string> Revoked() const { return _records.RevokedNodes(); }
    std::string FolderOf(const std::string &node) const { return _folder + "/" + node; }
    Envelope::Epoch Epoch() const;
    // The request from which the node's present keys were made.
    Request RequestOf(const std::string &node) const;

    // Makes the folder of a node, and issues the bulletin of the present epoch anew, with the secret for that
    // node, too: the other nodes need not hear of it. With `signing`, a request of that node, the folder has
    // no private key: the node has it.
    void Add(const Request &request, const Period &period, const MemberRequest *signing = nullptr) const;
    // Throws unless Add takes each of these requests, one after the other.
    void CheckAdd(const std::vector<MemberRequest> &requests) const;
    // Replaces the node's certificate and permissions by new ones, and its keys by new ones or by those of
    // `signing`. Without `signing`, a node whose folder has no private key keeps its keys. The old ones stay
    // good until they are revoked.
    void Renew(const Request &request, const Period &period, const MemberRequest *signing = nullptr) const;
    // Throws if the certificate that Renew would make has a key of an older one. RevokeOlder would protect
    // nothing then: a thief of the private key uses the new certificate, which is public.
    void CheckNewKey(const std::string &node, const MemberRequest *signing = nullptr) const;
    // RevokeOlder revokes every certificate that was made for the node except its present one, and throws if
    // one of these has a key of the present one. Revoke revokes all, and removes the node's folder. Both
    // begin an epoch if there is anything to revoke, write its bulletin into the folder of each node, and
    // return how many certificates they revoked. A certificate that has ended, and was followed by another
    // one, gets no secret in the new epoch.
    std::size_t RevokeOlder(const std::string &node, std::time_t now) const;
    std::size_t Revoke(const std::string &node, std::time_t now) const;

private:
    // The private key, and the one to which the secrets of epochs are sealed.
    struct Opened
    {
        Envelope::SigningKey Signing;
        Envelope::AgreementKey Agreement;
    };

    static Opened Open(const Envelope::SecretKey &seed);
    Opened &Key() const;
    static void CheckKeepsNoKey(const std::vector<Envelope::Certificate> &older, const std::string &node,
                                const MemberPublic &keys);
    // Returns the keys, which are fresh, that the node's next certificate will have; empty: new ones.
    std::optional<MemberPublic> KeysFor(const std::string &node, const MemberRequest *signing) const;
    // The same for a node that must not have a folder yet.
    std::optional<MemberPublic> KeysForNew(const std::string &node, const MemberRequest *signing) const;
    void Make(const std::string &folder, const Request &request, const Period &period,
              const std::optional<MemberPublic> &known) const;
    // Returns all bulletins that the authority keeps, each with a secret for every certificate of these that
    // is not revoked.
    Bulletins IssueAnew(const std::vector<Envelope::Certificate> &certificates) const;
    std::size_t RevokeAll(const std::vector<Envelope::Certificate> &certificates, std::time_t now) const;
    void WriteToNodes(const std::string &bulletins) const;

    const std::string _folder;
    const AskPassphrase _ask;
    const FleetLock _lock;
    const FleetRecords _records;
    mutable std::optional<Opened> _key;  // read when first needed
};

}  // namespace Rabit::Keys
