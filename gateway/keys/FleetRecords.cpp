#include "keys/FleetRecords.h"

#include <rabit/keys/KeysError.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "envelope/Bulletin.h"
#include "envelope/VerifyingKey.h"
#include "keys/KeyFiles.h"
#include "keys/MemberFiles.h"
#include "keys/NodeName.h"

namespace Rabit::Keys
{

FleetRecords::FleetRecords(const std::string &fleet) : _folder(fleet + "/" + AuthorityFolder)
{
    const std::string file = Place(AuthorityPublicFile);
    _public = ReadPublicKey(ReadFile(file), file);
}

std::string FleetRecords::Place(const std::string &name) const
{
    return _folder + "/" + name;
}

Bulletins FleetRecords::Published() const
{
    Envelope::VerifyingKey authority = VerifyingKeyOf(_public);
    const std::string file = Place(AuthorityBulletinFile);
    return ReadBulletins(ReadFile(file), authority, file);
}

void FleetRecords::Publish(const std::string &bulletins) const
{
    WriteFile(Place(AuthorityBulletinFile), bulletins);
}

std::vector<Envelope::Serial> FleetRecords::Revoked() const
{
    const Bulletins published = Published();
    Envelope::VerifyingKey authority = VerifyingKeyOf(_public);
    const auto newest = Envelope::Bulletin::Read(published.rbegin()->second, authority);
    return newest ? newest->Revoked() : std::vector<Envelope::Serial>();
}

std::vector<std::string> FleetRecords::RevokedNodes() const
{
    const std::vector<Envelope::Serial> revoked = Revoked();
    std::map<std::string, bool> areRevoked;
    for (const Envelope::Certificate &one : Issued())
    {
        bool &all = areRevoked.try_emplace(one.Name, true).first->second;
        all = all && std::find(revoked.begin(), revoked.end(), one.Number) != revoked.end();
    }
    std::vector<std::string> nodes;
    for (const auto &[node, are] : areRevoked)
    {
        if (are)
        {
            nodes.push_back(node);
        }
    }
    return nodes;
}

std::vector<Envelope::Certificate> FleetRecords::Issued() const
{
    Envelope::VerifyingKey authority = VerifyingKeyOf(_public);
    std::vector<Envelope::Certificate> certificates;
    for (const auto &entry : std::filesystem::directory_iterator(Place(AuthorityIssuedFolder)))
    {
        const std::string file = entry.path().string();
        if (entry.path().extension() == ".new")
        {
            continue;  // was cut short
        }
        const Bytes bytes = BlockIn(ReadFile(file), CertificateLabel, file);
        const auto certificate = Envelope::ReadCertificate(bytes);
        if (!certificate || !Envelope::IsCertifiedBy(bytes, authority))
        {
            throw KeysError(file + " is no certificate that the authority signed; remove it if you know why");
        }
        certificates.push_back(*certificate);
    }
    std::sort(certificates.begin(), certificates.end(),
              [](const auto &one, const auto &other) { return one.Number < other.Number; });
    return certificates;
}

std::vector<Envelope::Certificate> FleetRecords::IssuedTo(const std::string &node) const
{
    std::vector<Envelope::Certificate> certificates = Issued();
    std::erase_if(certificates, [&node](const auto &one) { return one.Name != node; });
    return certificates;
}

void FleetRecords::AddIssued(Envelope::Serial number, const Bytes &certificate) const
{
    WriteFile(Place(std::string(AuthorityIssuedFolder) + "/" + std::to_string(number)),
              Armoured(CertificateLabel, certificate));
}

// A key that two nodes have was copied with a disk, and a key with a revoked certificate may be stolen.
void FleetRecords::CheckFresh(const std::string &node, const MemberPublic &keys) const
{
    const std::vector<Envelope::Serial> revoked = Revoked();
    for (const Envelope::Certificate &one : Issued())
    {
        if (!HasAKeyOf(one, keys))
        {
            continue;
        }
        if (one.Name != node)
        {
            throw KeysError("the request of " + node + " has the key of " + one.Name +
                            ": each node needs its own; make it with `rabit keys request` on " + node);
        }
        if (std::find(revoked.begin(), revoked.end(), one.Number) != revoked.end())
        {
            throw KeysError(node +
                            " has a key whose certificate is revoked; remove the key on the node, and make "
                            "another with `rabit keys request`");
        }
    }
}

MemberPublic KeysOf(const Envelope::Certificate &certificate)
{
    return {.Signing = certificate.Signing, .Agreement = certificate.Agreement};
}

bool HasAKeyOf(const Envelope::Certificate &certificate, const MemberPublic &keys)
{
    return certificate.Signing == keys.Signing || certificate.Agreement == keys.Agreement;
}

}  // namespace Rabit::Keys
