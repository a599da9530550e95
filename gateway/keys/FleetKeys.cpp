#include "keys/FleetKeys.h"

#include <algorithm>
#include <filesystem>

#include "keys/KeyFiles.h"
#include "keys/KeysError.h"
#include "keys/NodeFolders.h"
#include "keys/SignedDocument.h"

namespace Rabit::Keys
{
namespace
{

namespace fs = std::filesystem;

constexpr const char *IssuedFolder = "issued";
constexpr const char *RevokedFile = "revoked.pem";
constexpr std::time_t Day = 24 * 60 * 60;

// Begins a day before now, for clocks that are slow.
Validity ValidityFrom(const FleetKeys::Period &period)
{
    return {period.Now - Day, period.Now + period.Days * Day};
}

}  // namespace

void FleetKeys::Init(const std::string &folder, const std::string &fleet, const Period &period,
                     std::string_view passphrase)
{
    if (!IsFolderName(fleet))
    {
        throw KeysError("`" + fleet +
                        "` cannot be the name of a fleet; expected 1 to 64 of A-Z a-z 0-9 _ . -, no dot in "
                        "front");
    }
    if (!fs::exists(folder))
    {
        MakeSecretFolder(folder);
    }
    if (IsFleet(folder))
    {
        throw KeysError(folder + " has the authorities of a fleet already: nothing is changed");
    }
    const std::string made = folder + "/.authority.new";
    std::error_code ignored;
    fs::remove_all(made, ignored);
    MakeSecretFolder(made);
    MakeSecretFolder(made + "/" + IssuedFolder);
    for (const std::string name : {"identity", "permissions"})
    {
        const KeyPtr key = MakeKey();
        const CertificatePtr certificate =
            MakeAuthority(fleet, name + " authority", *key, ValidityFrom(period));
        WriteSecret(made + "/" + name + "_key.pem", PemOf(*key, passphrase));
        WriteFile(made + "/" + name + ".pem", PemOf(*certificate));
        if (name == "identity")
        {
            WriteFile(made + "/" + RevokedFile,
                      PemOf(*MakeRevocations(nullptr, {}, *certificate, *key, period.Now)));
        }
    }
    MoveFolder(made, folder + "/" + AuthorityFolder);
}

bool FleetKeys::IsFleet(const std::string &folder)
{
    return fs::is_directory(folder + "/" + AuthorityFolder);
}

FleetKeys::FleetKeys(const std::string &folder, AskPassphrase ask)
    : _folder(folder), _ask(std::move(ask)), _lock(folder)
{
    const CertificatePtr identity = Authority("identity");
    _fleet = FleetOf(*identity);
    _validity = ValidityOf(*identity);
    FinishReplacements(_folder);
}

CertificatePtr FleetKeys::Authority(const char *name) const
{
    return CertificateIn(Place(std::string(name) + ".pem"));
}

EVP_PKEY &FleetKeys::AuthorityKey(const char *name) const
{
    KeyPtr &key = _authorityKeys[name];
    if (!key)
    {
        const std::string file = Place(std::string(name) + "_key.pem");
        key = ReadKey(ReadSecret(file), file, _ask);
    }
    return *key;
}

std::vector<std::string> FleetKeys::Nodes() const
{
    return FoldersWith(_folder, "certificate.pem");
}

FleetKeys::Request FleetKeys::RequestOf(const std::string &node) const
{
    CheckNodeName(node);
    const NodeKeys keys(FolderOf(node), PrivateKeyPlace::HereOrOnNode);
    Request request{.Node = node, .SmallGuid = HasSmallGuid(keys.Subject()), .Access = {}};
    for (const Permissions::Rule &rule : keys.Permissions().Rules)
    {
        const bool isPlain = rule.Allows && rule.Domains.size() == 1 &&
                             rule.Domains.front().first == rule.Domains.front().second;
        if (!isPlain || keys.Permissions().Rules.size() != 1)
        {
            throw KeysError(keys.Files().Permissions +
                            " was written by hand; name the node's configuration with --config");
        }
        request.Access = {rule.Domains.front().first, rule.Publish, rule.Subscribe};
    }
    return request;
}

std::vector<std::string> FleetKeys::Issued(const std::string &node) const
{
    std::vector<std::string> files;
    for (const std::string &file : Issued())
    {
        // `uav1.7.pem`
        if (fs::path(file).stem().stem().string() == node)
        {
            files.push_back(file);
        }
    }
    return files;
}

std::vector<std::string> FleetKeys::Issued() const
{
    std::vector<std::string> files;
    for (const auto &entry : fs::directory_iterator(Place(IssuedFolder)))
    {
        if (entry.path().extension() == ".pem")
        {
            files.push_back(entry.path().string());
        }
    }
    std::sort(files.begin(), files.end());
    return files;
}

std::vector<std::string> FleetKeys::Revoked() const
{
    const std::string place = Place(RevokedFile);
    const RevocationsPtr revoked = ReadRevocations(ReadFile(place), place);
    std::map<std::string, bool> areRevoked;
    for (const std::string &file : Issued())
    {
        const CertificatePtr certificate = CertificateIn(file);
        bool &all = areRevoked.try_emplace(SubjectOf(*certificate).Node, true).first->second;
        all = all && IsRevoked(*revoked, *certificate);
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

// A key that two nodes have was copied with a disk, and a key with a revoked certificate may be stolen.
void FleetKeys::CheckFresh(const std::string &node, const EVP_PKEY &key) const
{
    const std::string place = Place(RevokedFile);
    const RevocationsPtr revoked = ReadRevocations(ReadFile(place), place);
    for (const std::string &file : Issued())
    {
        const CertificatePtr certificate = CertificateIn(file);
        if (!IsKeyOf(key, *certificate))
        {
            continue;
        }
        if (const std::string owner = SubjectOf(*certificate).Node; owner != node)
        {
            throw KeysError("the request of " + node + " has the key of " + owner +
                            ": each node needs its own; make it with `rabit keys request` on " + node);
        }
        if (IsRevoked(*revoked, *certificate))
        {
            throw KeysError(node +
                            " has a key whose certificate is revoked; remove the key on the node, and make "
                            "another with `rabit keys request`");
        }
    }
}

// Returns a number that no certificate of the node has had: old permissions name the old subject.
unsigned FleetKeys::NextNumber(const Request &request) const
{
    SubjectName subject{.Fleet = _fleet, .Number = 0, .Node = request.Node};
    for (const std::string &file : Issued(request.Node))
    {
        subject.Number = std::max(subject.Number, SubjectOf(*CertificateIn(file)).Number + 1);
    }
    while (subject.Number <= SubjectName::LargestNumber && HasSmallGuid(subject) != request.SmallGuid)
    {
        ++subject.Number;
    }
    if (subject.Number > SubjectName::LargestNumber)
    {
        throw KeysError("too many certificates were made for " + request.Node +
                        "; give it another name, or make a new fleet");
    }
    return subject.Number;
}

KeyPtr FleetKeys::KeyFor(const std::string &node, const SigningRequest *signing) const
{
    KeyPtr key;
    const NodeFiles files(FolderOf(node));
    if (signing != nullptr)
    {
        if (signing->Node != node)
        {
            throw KeysError("the request is of `" + signing->Node + "`, not of `" + node + "`");
        }
        EVP_PKEY_up_ref(signing->PublicKey.get());
        key.reset(signing->PublicKey.get());
    }
    else if (fs::exists(files.Certificate) && !fs::exists(files.PrivateKey))
    {
        key.reset(X509_get_pubkey(CertificateIn(files.Certificate).get()));
    }
    if (key)
    {
        CheckFresh(node, *key);
    }
    return key;
}

void FleetKeys::CheckIsNotKeyOf(const std::vector<std::string> &files, const std::string &node,
                                const EVP_PKEY &key) const
{
    for (const std::string &file : files)
    {
        if (IsKeyOf(key, *CertificateIn(file)))
        {
            throw KeysError(node +
                            " keeps its key, so revoking the older certificates protects nothing: "
                            "nothing is revoked; renew it with `--request`");
        }
    }
}

void FleetKeys::CheckNewKey(const std::string &node, const SigningRequest *signing) const
{
    CheckNodeName(node);
    if (const KeyPtr key = KeyFor(node, signing))
    {
        CheckIsNotKeyOf(Issued(node), node, *key);
    }
}

void FleetKeys::Make(const std::string &folder, const Request &request, const Period &period,
                     EVP_PKEY *publicKey) const
{
    if (request.Access.Domain > LargestDomain)
    {
        throw KeysError("keys are for the domains 0 to " + std::to_string(LargestDomain) + ", not for " +
                        std::to_string(request.Access.Domain));
    }
    const Validity validity = ValidityFrom(period);
    if (validity.To > _validity.To)
    {
        throw KeysError("the fleet's own certificates end on " + DayText(_validity.To) +
                        ", before those that are asked for; ask for fewer days, or make a new fleet");
    }
    const CertificatePtr identity = Authority("identity");
    const CertificatePtr permissions = Authority("permissions");
    EVP_PKEY &permissionsKey = AuthorityKey("permissions");
    const SubjectName subject{.Fleet = _fleet, .Number = NextNumber(request), .Node = request.Node};
    const KeyPtr made = publicKey == nullptr ? MakeKey() : nullptr;
    const CertificatePtr certificate =
        MakeCertificate(subject, made ? *made : *publicKey, validity, *identity, AuthorityKey("identity"));
    const std::string document =
        SignDocument(PermissionsText(subject, validity, request.Access), *permissions, permissionsKey);
    if (document.size() > LargestDocument)
    {
        throw KeysError("the permissions of " + request.Node + " take " + std::to_string(document.size()) +
                        " bytes, and DDS can show others no more than " + std::to_string(LargestDocument) +
                        ": too many topics for one node");
    }

    std::error_code ignored;
    fs::remove_all(folder, ignored);
    MakeSecretFolder(folder);
    const NodeFiles files(folder);
    WriteFile(files.IdentityAuthority, PemOf(*identity));
    WriteFile(files.PermissionsAuthority, PemOf(*permissions));
    if (made)
    {
        WriteSecret(files.PrivateKey, PemOf(*made));
    }
    WriteFile(files.Certificate, PemOf(*certificate));
    WriteFile(files.Revoked, ReadFile(Place(RevokedFile)));
    for (const Level level : {Level::Sign, Level::Encrypt})
    {
        WriteFile(files.Governance(level), SignDocument(GovernanceText(level), *permissions, permissionsKey));
    }
    WriteFile(files.Permissions, document);
    WriteFile(
        Place(std::string(IssuedFolder) + "/" + request.Node + "." + std::to_string(subject.Number) + ".pem"),
        PemOf(*certificate));
}

void FleetKeys::Add(const Request &request, const Period &period, const SigningRequest *signing) const
{
    CheckNodeName(request.Node);
    const std::string folder = FolderOf(request.Node);
    if (fs::exists(folder))
    {
        throw KeysError(folder + " is there already: nothing is changed; `rabit keys renew` makes new ones");
    }
    const std::string made = NewFolderOf(_folder, request.Node);
    Make(made, request, period, KeyFor(request.Node, signing).get());
    MoveFolder(made, folder);
}

void FleetKeys::Renew(const Request &request, const Period &period, const SigningRequest *signing) const
{
    CheckNodeName(request.Node);
    const std::string folder = FolderOf(request.Node);
    if (!fs::exists(folder))
    {
        throw KeysError("there is no folder " + folder + "; `rabit keys add` makes one");
    }
    Make(NewFolderOf(_folder, request.Node), request, period, KeyFor(request.Node, signing).get());
    ReplaceFolder(_folder, request.Node);
}

std::size_t FleetKeys::RevokeFiles(const std::vector<std::string> &files, std::time_t now) const
{
    const std::string place = Place(RevokedFile);
    const RevocationsPtr before = ReadRevocations(ReadFile(place), place);
    std::vector<CertificatePtr> certificates;
    std::vector<const X509 *> revoked;
    for (const std::string &file : files)
    {
        CertificatePtr certificate = CertificateIn(file);
        if (!IsRevoked(*before, *certificate))
        {
            revoked.push_back(certificate.get());
            certificates.push_back(std::move(certificate));
        }
    }
    const std::string text =
        PemOf(*MakeRevocations(before.get(), revoked, *Authority("identity"), AuthorityKey("identity"), now));
    WriteFile(place, text);
    for (const std::string &node : Nodes())
    {
        WriteFile(NodeFiles(FolderOf(node)).Revoked, text);
    }
    return revoked.size();
}

std::size_t FleetKeys::RevokeOlder(const std::string &node, std::time_t now) const
{
    CheckNodeName(node);
    const CertificatePtr present = CertificateIn(NodeFiles(FolderOf(node)).Certificate);
    std::vector<std::string> files = Issued(node);
    std::erase_if(files, [&](const std::string &one) { return AreSame(*CertificateIn(one), *present); });
    CheckIsNotKeyOf(files, node, *X509_get0_pubkey(present.get()));
    return RevokeFiles(files, now);
}

std::size_t FleetKeys::Revoke(const std::string &node, std::time_t now) const
{
    CheckNodeName(node);
    const std::vector<std::string> files = Issued(node);
    if (files.empty())
    {
        throw KeysError("no certificate was ever made for " + node + " in " + _folder);
    }
    const std::size_t count = RevokeFiles(files, now);
    std::error_code error;
    fs::remove_all(FolderOf(node), error);
    if (error)
    {
        throw KeysError(node + " is revoked, and its folder cannot be removed: " + error.message());
    }
    return count;
}

}  // namespace Rabit::Keys
