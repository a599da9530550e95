#pragma once

#include <rabit/transport/FleetMember.h>

#include <optional>
#include <string>
#include <vector>

#include "envelope/Certificate.h"
#include "envelope/Permissions.h"
#include "envelope/Types.h"
#include "keys/Access.h"
#include "keys/BulletinStore.h"
#include "keys/MemberFiles.h"
#include "keys/MemberSecrets.h"

namespace Rabit::Keys
{

// Where a node's private keys are: with the other files, or, if those are for a node that made a request,
// perhaps on the node alone.
enum class KeyPlace
{
    Here,
    HereOrOnNode
};

// The folder of a node, checked as far as this host can: each file can be read, the authority signed it, the
// files belong together, and only the owner can read the keys.
class MemberFolder
{
public:
    // `stored`: a file of bulletins that the node stored because it could not write into the folder. It may
    // be missing, and what the authority did not sign is passed over. Empty: there is none. Throws KeysError.
    explicit MemberFolder(const std::string &folder, KeyPlace place = KeyPlace::Here,
                          std::string stored = {});

    const MemberFiles &Files() const { return _files; }
    const Envelope::Certificate &Certificate() const { return _certificate; }
    const Envelope::Permissions &Allowed() const { return *_allowed; }
    const Envelope::PublicKey &Authority() const { return _authority; }
    // Of the newest bulletin.
    Envelope::Epoch Epoch() const { return _bulletins.rbegin()->first; }
    // False only with KeyPlace::HereOrOnNode.
    bool HasKey() const { return _secrets.has_value(); }

    // Returns, in one line for people, why the node cannot use these keys; empty if it can. The dates of the
    // certificate are no reason: they are for warnings.
    std::string WhyNot(const std::string &node) const;
    // Returns the parts of `access` that the permissions do not allow, each as `write Pose` or `read Pose`.
    std::vector<std::string> Lacks(const Access &access) const;

    // The bytes for MakeFleetMember, which stores newer bulletins in the folder, or in `stored`. HasKey and
    // an empty WhyNot are required.
    MemberKeys Keys() const;

private:
    void ReadCertified(Envelope::VerifyingKey &authority);
    void ReadStored(Envelope::VerifyingKey &authority);
    void ReadSecrets(KeyPlace place);
    // The bulletins that have a secret for this certificate.
    Bulletins Readable() const;

    const MemberFiles _files;
    const std::string _stored;
    Envelope::PublicKey _authority{};
    Bytes _certificateBytes;
    Envelope::Certificate _certificate;
    Bytes _list;
    std::optional<Envelope::Permissions> _allowed;  // never empty once made
    Bulletins _bulletins;
    bool _isRevoked = false;
    std::optional<MemberSecrets> _secrets;
};

}  // namespace Rabit::Keys
