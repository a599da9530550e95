#pragma once

#include <array>
#include <ctime>
#include <string>
#include <vector>

#include "keys/Access.h"
#include "keys/Governance.h"
#include "keys/Permissions.h"

namespace Rabit::Keys
{

// The names of the files in a node's folder.
struct NodeFiles
{
    explicit NodeFiles(const std::string &folder);

    const std::string &Governance(Level level) const
    {
        return level == Level::Sign ? GovernanceSign : GovernanceEncrypt;
    }

    std::string IdentityAuthority;
    std::string PermissionsAuthority;
    std::string Certificate;
    std::string PrivateKey;
    std::string Revoked;
    std::string GovernanceSign;
    std::string GovernanceEncrypt;
    std::string Permissions;
};

// The place of a node's private key: with the other files, or, if those are for a node that made a request,
// perhaps on the node alone.
enum class PrivateKeyPlace
{
    Here,
    HereOrOnNode
};

// The folder of a node, checked as far as this host can: each file exists and is valid, the files belong
// together, and only the owner can read the private key.
class NodeKeys
{
public:
    // Throws KeysError.
    explicit NodeKeys(const std::string &folder, PrivateKeyPlace place = PrivateKeyPlace::Here);

    const NodeFiles &Files() const { return _files; }
    const SubjectName &Subject() const { return _subject; }
    // False only with PrivateKeyPlace::HereOrOnNode.
    bool HasPrivateKey() const { return _hasPrivateKey; }
    const Validity &ValidityOf() const { return _validity; }
    // Outside of this time the node would refuse everybody.
    const Validity &ValidityOfRevocations() const { return _validityOfRevocations; }
    const Rabit::Keys::Permissions &Permissions() const { return _permissions; }

    // Returns, in one line for people, why the node cannot use these keys now; empty if it can.
    std::string WhyNot(const std::string &node, const std::string &transport, int domain,
                       std::time_t now) const;
    // The same, whatever the clock says.
    std::string WhyNever(const std::string &node, const std::string &transport, int domain) const;
    // Returns the parts of `access` that the permissions do not allow, each as `write Pose` or `read Pose`.
    std::vector<std::string> Lacks(const Access &access) const;

private:
    NodeFiles _files;
    SubjectName _subject;
    Validity _validity;
    Validity _validityOfRevocations;
    bool _hasPrivateKey = true;
    bool _isRevoked = false;
    Rabit::Keys::Permissions _permissions;
};

}  // namespace Rabit::Keys
