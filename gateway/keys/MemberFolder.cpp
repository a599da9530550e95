#include "keys/MemberFolder.h"

#include <rabit/keys/KeysError.h>
#include <rabit/keys/NodeOfKeys.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <utility>

#include "envelope/Bulletin.h"
#include "keys/KeyFiles.h"
#include "keys/MemberPermissions.h"
#include "keys/NodeFolders.h"
#include "keys/NodeName.h"

namespace Rabit::Keys
{
namespace
{

bool IsRevokedIn(const Bulletins &bulletins, Envelope::VerifyingKey &authority, Envelope::Serial number)
{
    const auto newest = Envelope::Bulletin::Read(bulletins.rbegin()->second, authority);
    const std::vector<Envelope::Serial> revoked =
        newest ? newest->Revoked() : std::vector<Envelope::Serial>();
    return std::find(revoked.begin(), revoked.end(), number) != revoked.end();
}

}  // namespace

MemberFolder::MemberFolder(const std::string &folder, KeyPlace place, std::string stored)
    : _files(folder), _stored(std::move(stored))
{
    if (!std::filesystem::is_directory(folder))
    {
        throw KeysError("there is no folder of keys " + folder + "; `rabit keys add` makes one");
    }
    CheckFormat(folder);
    if (std::filesystem::is_directory(folder + "/" + AuthorityFolder))
    {
        throw KeysError(folder + " is the folder of a fleet; name the folder of one node in it, as " +
                        folder + "/NODE");
    }
    if (!std::filesystem::exists(_files.Certificate))
    {
        throw KeysError("there is no " + _files.Certificate +
                        "; copy the files to it that `rabit keys sign` makes of the node's request");
    }
    _authority = ReadPublicKey(ReadFile(_files.Authority), _files.Authority);
    Envelope::VerifyingKey authority = VerifyingKeyOf(_authority);
    ReadCertified(authority);
    _bulletins = ReadBulletins(ReadFile(_files.Bulletin), authority, _files.Bulletin);
    ReadStored(authority);
    _isRevoked = IsRevokedIn(_bulletins, authority, _certificate.Number);
    ReadSecrets(place);
}

void MemberFolder::ReadCertified(Envelope::VerifyingKey &authority)
{
    _certificateBytes = BlockIn(ReadFile(_files.Certificate), CertificateLabel, _files.Certificate);
    const auto certificate = Envelope::ReadCertificate(_certificateBytes);
    if (!certificate || !Envelope::IsCertifiedBy(_certificateBytes, authority))
    {
        throw KeysError(_files.Certificate +
                        " is not signed by the authority beside it: it is of another fleet, or was changed");
    }
    _certificate = *certificate;
    _list = BlockIn(ReadFile(_files.Permissions), PermissionsLabel, _files.Permissions);
    _allowed = Envelope::Permissions::Read(_list);
    if (!_allowed || Envelope::Permissions::HashOf(_list) != _certificate.Permissions)
    {
        throw KeysError(_files.Permissions +
                        " does not belong to the certificate: permissions of another node, older than the "
                        "certificate, or changed");
    }
}

void MemberFolder::ReadStored(Envelope::VerifyingKey &authority)
{
    if (_stored.empty() || !std::filesystem::exists(_stored))
    {
        return;
    }
    try
    {
        // Those of the folder hold: a person copied them.
        _bulletins.merge(ReadBulletins(ReadFile(_stored), authority, _stored));
        KeepNewest(_bulletins);
    }
    catch (const KeysError &)
    {
        // The file is of another fleet, whose keys the node had before. The next bulletin replaces it.
    }
}

void MemberFolder::ReadSecrets(KeyPlace place)
{
    if (!std::filesystem::exists(_files.Key))
    {
        if (place == KeyPlace::Here)
        {
            throw KeysError(
                "there is no " + _files.Key +
                "; a node that made a request has it, and needs the other files in the same folder");
        }
        return;
    }
    _secrets = MemberSecrets::Read(ReadSecret(_files.Key), _files.Key);
    const MemberPublic shown = MemberPublic::Of(*_secrets);
    if (shown.Signing != _certificate.Signing || shown.Agreement != _certificate.Agreement)
    {
        throw KeysError(_files.Key + " is not the key of the certificate beside it");
    }
}

Bulletins MemberFolder::Readable() const
{
    Bulletins readable;
    Envelope::VerifyingKey authority = VerifyingKeyOf(_authority);
    const Envelope::AgreementKey key = AgreementKeyOf(_secrets->Agreement);
    for (const auto &[epoch, bytes] : _bulletins)
    {
        const auto bulletin = Envelope::Bulletin::Read(bytes, authority);
        if (bulletin && bulletin->Secret(_certificate.Number, key))
        {
            readable.emplace(epoch, bytes);
        }
    }
    return readable;
}

std::string MemberFolder::WhyNot(const std::string &node) const
{
    const std::string &file = _files.Certificate;
    if (_certificate.Name != node)
    {
        return file + " is for the node `" + _certificate.Name + "`, and this is `" + node + "`";
    }
    if (_isRevoked)
    {
        return file +
               " is revoked; make new keys with `rabit keys add`, or another request with "
               "`rabit keys request` after removing the key";
    }
    if (HasKey() && Readable().count(Epoch()) == 0)
    {
        return _files.Bulletin + " has no secret for the certificate beside it in epoch " +
               std::to_string(Epoch()) + ": copy all files of the node's folder again";
    }
    return "";
}

std::vector<std::string> MemberFolder::Lacks(const Access &access) const
{
    return Keys::Lacks(*_allowed, _certificate.Role, access);
}

MemberKeys MemberFolder::Keys() const
{
    MemberKeys keys;
    keys.SigningKey = _secrets->Signing.Bytes();
    keys.AgreementKey = _secrets->Agreement.Bytes();
    keys.Certificate = _certificateBytes;
    keys.Permissions = _list;
    keys.Authority = _authority;
    for (const auto &[epoch, bytes] : Readable())
    {
        keys.Bulletins.push_back(bytes);
    }
    const auto store =
        std::make_shared<BulletinStore>(_files.Bulletin, _stored, _bulletins, VerifyingKeyOf(_authority));
    keys.Store = [store](std::uint16_t epoch, std::span<const std::uint8_t> bulletin)
    { return store->Add(epoch, bulletin); };
    return keys;
}

std::string NodeOfKeys(const std::string &folder)
{
    return MemberFolder(folder).Certificate().Name;
}

}  // namespace Rabit::Keys
