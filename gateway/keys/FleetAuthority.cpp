#include "keys/FleetAuthority.h"

#include <rabit/keys/KeysError.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <utility>

#include "envelope/Bulletin.h"
#include "envelope/KeyDerivation.h"
#include "keys/KeyFiles.h"
#include "keys/MemberFolder.h"
#include "keys/NodeName.h"

namespace Rabit::Keys
{
namespace
{

constexpr std::string_view AgreementContext = "Rabit authority 1";
// Of the authority itself, in bulletins. Certificates begin at 1.
constexpr Envelope::Serial OwnSerial = 0;
constexpr std::time_t OneDay = 24 * 60 * 60;

std::uint32_t SecondsOf(std::time_t time)
{
    constexpr std::time_t latest = std::numeric_limits<std::uint32_t>::max();
    return static_cast<std::uint32_t>(std::clamp<std::time_t>(time, 0, latest));
}

Bytes NewBulletin(Envelope::Epoch epoch, const std::vector<Envelope::Serial> &revoked,
                  std::vector<Envelope::BulletinNode> nodes, const Envelope::SecretKey &secret,
                  const Envelope::AgreementKey &own, Envelope::SigningKey &authority)
{
    nodes.push_back({.Number = OwnSerial, .Agreement = own.Public()});
    const std::size_t count = nodes.size();
    Bytes bytes = Envelope::Bulletin::Write(epoch, revoked, std::move(nodes), secret,
                                            AgreementKeyOf(RandomSecret()), authority);
    if (bytes.empty())
    {
        throw KeysError("cannot make a bulletin for " + std::to_string(count) + " certificates without " +
                        std::to_string(revoked.size()) + " revoked ones; there is room for " +
                        std::to_string(Envelope::MostBulletinNodes) + " and " +
                        std::to_string(Envelope::MostRevoked) + ": make a new fleet");
    }
    return bytes;
}

std::vector<Envelope::BulletinNode> NodesOf(const std::vector<Envelope::Certificate> &certificates,
                                            const std::vector<Envelope::Serial> &revoked)
{
    std::vector<Envelope::BulletinNode> nodes;
    for (const Envelope::Certificate &one : certificates)
    {
        if (std::find(revoked.begin(), revoked.end(), one.Number) == revoked.end())
        {
            nodes.push_back({.Number = one.Number, .Agreement = one.Agreement});
        }
    }
    return nodes;
}

}  // namespace

void FleetAuthority::Init(const std::string &folder, std::string_view passphrase)
{
    CheckFormat(folder);
    if (!std::filesystem::exists(folder))
    {
        MakeSecretFolder(folder);
    }
    const std::string place = folder + "/" + AuthorityFolder;
    if (std::filesystem::exists(place))
    {
        throw KeysError(folder + " has the authority of a fleet already: nothing is changed");
    }
    const std::string made = folder + "/.authority.new";
    std::error_code ignored;
    std::filesystem::remove_all(made, ignored);
    MakeSecretFolder(made);
    MakeSecretFolder(made + "/" + AuthorityIssuedFolder);
    const Envelope::SecretKey seed = RandomSecret();
    Opened opened = Open(seed);
    WriteSecret(made + "/" + AuthorityKeyFile, SigningKeyPem(seed, passphrase));
    WriteFile(made + "/" + AuthorityPublicFile, PublicKeyPem(opened.Signing.Public()));
    const Bytes first = NewBulletin(1, {}, {}, RandomSecret(), opened.Agreement, opened.Signing);
    WriteFile(made + "/" + AuthorityBulletinFile, TextOf(Bulletins{{Envelope::Epoch{1}, first}}));
    MoveFolder(made, place);
}

bool FleetAuthority::IsIn(const std::string &folder)
{
    return std::filesystem::exists(folder + "/" + AuthorityFolder + "/" + AuthorityKeyFile) ||
           std::filesystem::exists(folder + "/" + AuthorityFolder + "/" + AuthorityBulletinFile);
}

FleetAuthority::FleetAuthority(const std::string &folder, AskPassphrase ask)
    : _folder(folder), _ask(std::move(ask)), _lock(folder), _records(folder)
{
    FinishReplacements(_folder);
}

FleetAuthority::Opened FleetAuthority::Open(const Envelope::SecretKey &seed)
{
    Envelope::SigningKey signing = SigningKeyOf(seed);
    const std::vector<std::uint8_t> context(AgreementContext.begin(), AgreementContext.end());
    const auto derived = Envelope::Hkdf(signing.Public(), seed.Bytes(), context);
    if (!derived)
    {
        throw KeysError("OpenSSL derives no key for the authority");
    }
    return {.Signing = std::move(signing), .Agreement = AgreementKeyOf(*derived)};
}

FleetAuthority::Opened &FleetAuthority::Key() const
{
    if (!_key)
    {
        const std::string file = _records.Place(AuthorityKeyFile);
        Opened opened = Open(ReadSigningKey(ReadSecret(file), file, _ask));
        if (opened.Signing.Public() != _records.Authority())
        {
            throw KeysError(file + " is not the key of the authority beside it");
        }
        _key.emplace(std::move(opened));
    }
    return *_key;
}

Envelope::Epoch FleetAuthority::Epoch() const
{
    return _records.Published().rbegin()->first;
}

std::vector<std::string> FleetAuthority::Nodes() const
{
    return FoldersWith(_folder, "certificate");
}

FleetAuthority::Request FleetAuthority::RequestOf(const std::string &node) const
{
    CheckNodeName(node);
    const MemberFolder folder(FolderOf(node), KeyPlace::HereOrOnNode);
    return {.Node = node, .Role = folder.Certificate().Role, .Allowed = folder.Allowed()};
}

void FleetAuthority::CheckKeepsNoKey(const std::vector<Envelope::Certificate> &older, const std::string &node,
                                     const MemberPublic &keys)
{
    if (std::any_of(older.begin(), older.end(), [&keys](const auto &one) { return HasAKeyOf(one, keys); }))
    {
        throw KeysError(node +
                        " keeps its key, so revoking the older certificates protects nothing: nothing is "
                        "revoked; renew it with `--request`");
    }
}

std::optional<MemberPublic> FleetAuthority::KeysFor(const std::string &node,
                                                    const MemberRequest *signing) const
{
    std::optional<MemberPublic> keys;
    const MemberFiles files(FolderOf(node));
    if (signing != nullptr)
    {
        if (signing->Node != node)
        {
            throw KeysError("the request is of `" + signing->Node + "`, not of `" + node + "`");
        }
        keys = signing->Keys;
    }
    else if (std::filesystem::exists(files.Certificate) && !std::filesystem::exists(files.Key))
    {
        keys = KeysOf(MemberFolder(FolderOf(node), KeyPlace::HereOrOnNode).Certificate());
    }
    if (keys)
    {
        _records.CheckFresh(node, *keys);
    }
    return keys;
}

void FleetAuthority::CheckNewKey(const std::string &node, const MemberRequest *signing) const
{
    CheckNodeName(node);
    if (const std::optional<MemberPublic> keys = KeysFor(node, signing))
    {
        CheckKeepsNoKey(_records.IssuedTo(node), node, *keys);
    }
}

Bulletins FleetAuthority::IssueAnew(const std::vector<Envelope::Certificate> &certificates) const
{
    const std::vector<Envelope::BulletinNode> nodes = NodesOf(certificates, _records.Revoked());
    Envelope::VerifyingKey authority = VerifyingKeyOf(_records.Authority());
    Bulletins anew;
    for (const auto &[epoch, bytes] : _records.Published())
    {
        const auto bulletin = Envelope::Bulletin::Read(bytes, authority);
        const auto secret = bulletin ? bulletin->Secret(OwnSerial, Key().Agreement) : std::nullopt;
        if (!secret)
        {
            throw KeysError(_records.Place(AuthorityBulletinFile) +
                            " has no secret for the authority in epoch " + std::to_string(epoch) +
                            "; restore the folder from a copy");
        }
        anew.emplace(epoch,
                     NewBulletin(epoch, bulletin->Revoked(), nodes, *secret, Key().Agreement, Key().Signing));
    }
    return anew;
}

void FleetAuthority::Make(const std::string &folder, const Request &request, const Period &period,
                          const std::optional<MemberPublic> &known) const
{
    std::vector<Envelope::Certificate> certificates = _records.Issued();
    const Envelope::Serial last = certificates.empty() ? OwnSerial : certificates.back().Number;
    const MemberSecrets secrets = MemberSecrets::Random();
    const MemberPublic keys = known ? *known : MemberPublic::Of(secrets);
    const Bytes list = request.Allowed.Bytes();
    // Begins a day before now, for clocks that are slow.
    const Envelope::Certificate certificate{.Name = request.Node,
                                            .Role = request.Role,
                                            .Number = last + 1,
                                            .Begins = SecondsOf(period.Now - OneDay),
                                            .Ends = SecondsOf(period.Now + period.Days * OneDay),
                                            .Signing = keys.Signing,
                                            .Agreement = keys.Agreement,
                                            .Permissions = Envelope::Permissions::HashOf(list)};
    const Bytes bytes = Envelope::WriteCertificate(certificate, Key().Signing);
    if (bytes.empty() || certificate.Number == OwnSerial)
    {
        throw KeysError("cannot make a certificate for " + request.Node);
    }
    certificates.push_back(certificate);
    const std::string bulletins = TextOf(IssueAnew(certificates));

    std::error_code ignored;
    std::filesystem::remove_all(folder, ignored);
    MakeSecretFolder(folder);
    const MemberFiles files(folder);
    WriteFile(files.Authority, PublicKeyPem(_records.Authority()));
    if (!known)
    {
        WriteSecret(files.Key, secrets.Pem());
    }
    WriteFile(files.Certificate, Armoured(CertificateLabel, bytes));
    WriteFile(files.Permissions, Armoured(PermissionsLabel, list));
    WriteFile(files.Bulletin, bulletins);
    // The serial is taken before anybody has the certificate.
    _records.AddIssued(certificate.Number, bytes);
    _records.Publish(bulletins);
}

std::optional<MemberPublic> FleetAuthority::KeysForNew(const std::string &node,
                                                       const MemberRequest *signing) const
{
    CheckNodeName(node);
    const std::string folder = FolderOf(node);
    if (std::filesystem::exists(folder))
    {
        throw KeysError(folder + " is there already: nothing is changed; `rabit keys renew` makes new ones");
    }
    return KeysFor(node, signing);
}

void FleetAuthority::CheckAdd(const std::vector<MemberRequest> &requests) const
{
    for (auto one = requests.begin(); one != requests.end(); ++one)
    {
        static_cast<void>(KeysForNew(one->Node, &*one));
        for (auto other = requests.begin(); other != one; ++other)
        {
            if (one->Node == other->Node)
            {
                throw KeysError("two of the requests are of `" + one->Node + "`: nothing is signed");
            }
            if (one->Keys.Signing == other->Keys.Signing || one->Keys.Agreement == other->Keys.Agreement)
            {
                throw KeysError("the requests of " + other->Node + " and " + one->Node +
                                " have the same key: each node needs its own");
            }
        }
    }
}

void FleetAuthority::Add(const Request &request, const Period &period, const MemberRequest *signing) const
{
    const std::optional<MemberPublic> keys = KeysForNew(request.Node, signing);
    const std::string made = NewFolderOf(_folder, request.Node);
    Make(made, request, period, keys);
    MoveFolder(made, FolderOf(request.Node));
}

void FleetAuthority::Renew(const Request &request, const Period &period, const MemberRequest *signing) const
{
    CheckNodeName(request.Node);
    const std::string folder = FolderOf(request.Node);
    if (!std::filesystem::exists(folder))
    {
        throw KeysError("there is no folder " + folder + "; `rabit keys add` makes one");
    }
    Make(NewFolderOf(_folder, request.Node), request, period, KeysFor(request.Node, signing));
    ReplaceFolder(_folder, request.Node);
}

void FleetAuthority::WriteToNodes(const std::string &bulletins) const
{
    for (const std::string &node : Nodes())
    {
        WriteFile(MemberFiles(FolderOf(node)).Bulletin, bulletins);
    }
}

std::size_t FleetAuthority::RevokeAll(const std::vector<Envelope::Certificate> &certificates,
                                      std::time_t now) const
{
    std::vector<Envelope::Serial> revoked = _records.Revoked();
    const std::size_t before = revoked.size();
    for (const Envelope::Certificate &one : certificates)
    {
        if (std::find(revoked.begin(), revoked.end(), one.Number) == revoked.end())
        {
            revoked.push_back(one.Number);
        }
    }
    Bulletins published = _records.Published();
    if (revoked.size() != before)
    {
        const Envelope::Epoch present = published.rbegin()->first;
        if (present + 1 >= Envelope::EpochOfCalls)
        {
            throw KeysError("no epoch is left: make a new fleet");
        }
        std::vector<Envelope::Certificate> remaining = _records.Issued();
        std::map<std::string, Envelope::Serial> newest;
        for (const Envelope::Certificate &one : remaining)
        {
            newest[one.Name] = one.Number;
        }
        std::erase_if(remaining, [&](const auto &one)
                      { return one.Ends < SecondsOf(now) && one.Number != newest[one.Name]; });
        const auto next = static_cast<Envelope::Epoch>(present + 1);
        published[next] = NewBulletin(next, revoked, NodesOf(remaining, revoked), RandomSecret(),
                                      Key().Agreement, Key().Signing);
        KeepNewest(published);
        _records.Publish(TextOf(published));
    }
    // Also if nothing is new: the revocation before may have been cut short.
    WriteToNodes(TextOf(published));
    return revoked.size() - before;
}

std::size_t FleetAuthority::RevokeOlder(const std::string &node, std::time_t now) const
{
    CheckNodeName(node);
    const MemberFolder folder(FolderOf(node), KeyPlace::HereOrOnNode);
    std::vector<Envelope::Certificate> older = _records.IssuedTo(node);
    std::erase_if(older, [&folder](const auto &one) { return one.Number == folder.Certificate().Number; });
    CheckKeepsNoKey(older, node, KeysOf(folder.Certificate()));
    return RevokeAll(older, now);
}

std::size_t FleetAuthority::Revoke(const std::string &node, std::time_t now) const
{
    CheckNodeName(node);
    const std::vector<Envelope::Certificate> certificates = _records.IssuedTo(node);
    if (certificates.empty())
    {
        throw KeysError("no certificate was ever made for " + node + " in " + _folder);
    }
    const std::size_t count = RevokeAll(certificates, now);
    std::error_code error;
    std::filesystem::remove_all(FolderOf(node), error);
    if (error)
    {
        throw KeysError(node + " is revoked, and its folder cannot be removed: " + error.message());
    }
    return count;
}

}  // namespace Rabit::Keys
