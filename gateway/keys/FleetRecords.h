#pragma once

#include <string>
#include <vector>

#include "envelope/Certificate.h"
#include "envelope/Types.h"
#include "keys/Armour.h"
#include "keys/BulletinStore.h"
#include "keys/MemberSecrets.h"

namespace Rabit::Keys
{

// Names of the files in the folder of an authority. The private key alone is secret.
inline constexpr const char *AuthorityKeyFile = "key";
inline constexpr const char *AuthorityPublicFile = "authority";
inline constexpr const char *AuthorityBulletinFile = "bulletin";
inline constexpr const char *AuthorityIssuedFolder = "issued";

// The public files in the folder of an authority: its public key, its bulletins, and each certificate that it
// made. All functions throw KeysError.
class FleetRecords
{
public:
    // Reads the public key.
    explicit FleetRecords(const std::string &fleet);

    const Envelope::PublicKey &Authority() const { return _public; }
    std::string Place(const std::string &name) const;

    Bulletins Published() const;
    // Replaces the bulletins.
    void Publish(const std::string &bulletins) const;
    // The serials of the newest bulletin.
    std::vector<Envelope::Serial> Revoked() const;
    // The nodes whose certificates are all revoked.
    std::vector<std::string> RevokedNodes() const;

    // Every certificate that was made, by rising serials.
    std::vector<Envelope::Certificate> Issued() const;
    std::vector<Envelope::Certificate> IssuedTo(const std::string &node) const;
    // Adds a certificate, whose serial is taken from then on.
    void AddIssued(Envelope::Serial number, const Bytes &certificate) const;
    // Throws if a node may not get a certificate for these keys: they are another node's, or revoked.
    void CheckFresh(const std::string &node, const MemberPublic &keys) const;

private:
    const std::string _folder;
    Envelope::PublicKey _public{};
};

MemberPublic KeysOf(const Envelope::Certificate &certificate);
// True if the certificate has one of these keys.
bool HasAKeyOf(const Envelope::Certificate &certificate, const MemberPublic &keys);

}  // namespace Rabit::Keys
