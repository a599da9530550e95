#include "keys/NodeKeys.h"

#include <algorithm>
#include <filesystem>

#include "keys/KeyFiles.h"
#include "keys/SignedDocument.h"

namespace Rabit::Keys
{
namespace
{

namespace fs = std::filesystem;

// Returns `write Pose`, `read Pose of uav1, uav2`.
std::string WordsFor(const char *what, const TopicAccess &access)
{
    std::string text = std::string(what) + " " + access.Topic;
    std::string of;
    for (const std::string &partition : access.Partitions)
    {
        of += partition.empty() ? "" : (of.empty() ? " of " : ", ") + partition;
    }
    return text + of;
}

std::string NotYet(const std::string &file, const std::string &begins, const std::string &now)
{
    return "the clock says " + now + ", and " + file + " is valid from " + begins +
           ": set the clock (an aircraft without a battery clock needs GPS or network time before it "
           "starts), then start again";
}

}  // namespace

NodeFiles::NodeFiles(const std::string &folder)
    : IdentityAuthority(folder + "/identity_authority.pem"),
      PermissionsAuthority(folder + "/permissions_authority.pem"),
      Certificate(folder + "/certificate.pem"),
      PrivateKey(folder + "/private_key.pem"),
      Revoked(folder + "/revoked.pem"),
      GovernanceSign(folder + "/governance_sign.p7s"),
      GovernanceEncrypt(folder + "/governance_encrypt.p7s"),
      Permissions(folder + "/permissions.p7s")
{
}

NodeKeys::NodeKeys(const std::string &folder, PrivateKeyPlace place)
    : _files(folder), _hasPrivateKey(fs::exists(_files.PrivateKey))
{
    if (!fs::is_directory(folder))
    {
        throw KeysError("there is no folder of keys " + folder + "; `rabit keys add` makes one");
    }
    if (_hasPrivateKey && !fs::exists(_files.Certificate))
    {
        throw KeysError("there is no " + _files.Certificate +
                        "; copy the files to it that `rabit keys sign` makes of the node's request");
    }
    const CertificatePtr identity = CertificateIn(_files.IdentityAuthority);
    const CertificatePtr permissions = CertificateIn(_files.PermissionsAuthority);
    if (IsKeyOf(*X509_get0_pubkey(identity.get()), *permissions))
    {
        throw KeysError(folder +
                        ": identity and permissions are of one authority, so that a node could sign its own "
                        "permissions; make two");
    }
    const CertificatePtr certificate = CertificateIn(_files.Certificate);
    if (!IsSignedBy(*certificate, *identity))
    {
        throw KeysError(_files.Certificate +
                        " is not signed by the identity authority beside it: it is of "
                        "another fleet");
    }
    if (!_hasPrivateKey && place == PrivateKeyPlace::Here)
    {
        throw KeysError("there is no " + _files.PrivateKey +
                        "; a node that made a request has it, and needs the other files in the same folder");
    }
    if (_hasPrivateKey && !IsKeyOf(*ReadKey(ReadSecret(_files.PrivateKey), _files.PrivateKey), *certificate))
    {
        throw KeysError(_files.PrivateKey + " is not the key of the certificate beside it");
    }
    _subject = SubjectOf(*certificate);
    _validity = Keys::ValidityOf(*certificate);
    const RevocationsPtr revoked = ReadRevocations(ReadFile(_files.Revoked), _files.Revoked);
    if (!IsSignedBy(*revoked, *identity))
    {
        throw KeysError(_files.Revoked +
                        " is not signed by the identity authority beside it, or was changed; copy the one of "
                        "this fleet");
    }
    _validityOfRevocations = Keys::ValidityOf(*revoked);
    _isRevoked = IsRevoked(*revoked, *certificate);
    for (const Level level : {Level::Sign, Level::Encrypt})
    {
        const std::string &file = _files.Governance(level);
        const std::string text = VerifiedDocument(ReadFile(file), *permissions, file);
        if (text != GovernanceText(level))
        {
            throw KeysError(file + " does not say what this version makes of the level `" + NameOf(level) +
                            "`; `rabit keys renew` makes it anew");
        }
    }
    const std::string text = VerifiedDocument(ReadFile(_files.Permissions), *permissions, _files.Permissions);
    for (Keys::Permissions &grant : ReadPermissions(text, _files.Permissions))
    {
        if (grant.Subject == _subject.Text())
        {
            _permissions = std::move(grant);
            return;
        }
        _permissions.Subject = grant.Subject;
    }
    throw KeysError(_files.Permissions + " is for `" + _permissions.Subject + "`, and the certificate for `" +
                    _subject.Text() + "`: permissions of another node, or older than the certificate");
}

std::string NodeKeys::WhyNot(const std::string &node, const std::string &transport, int domain,
                             std::time_t now) const
{
    if (std::string why = WhyNever(node, transport, domain); !why.empty())
    {
        return why;
    }
    if (now < _validity.From)
    {
        return NotYet(_files.Certificate, DayText(_validity.From), DayText(now));
    }
    if (now < _validityOfRevocations.From)
    {
        return NotYet(_files.Revoked, MinuteText(_validityOfRevocations.From), MinuteText(now));
    }
    if (now > _validity.To)
    {
        return _files.Certificate + " ended on " + DayText(_validity.To) + ", and the clock says " +
               DayText(now) + "; `rabit keys renew` makes a new one";
    }
    if (now > _validityOfRevocations.To)
    {
        return _files.Revoked + " ended on " + DayText(_validityOfRevocations.To) + ", and the clock says " +
               DayText(now) + "; copy the fleet's present one";
    }
    return "";
}

std::string NodeKeys::WhyNever(const std::string &node, const std::string &transport, int domain) const
{
    const std::string &file = _files.Certificate;
    if (_subject.Node != node)
    {
        return file + " is for the node `" + _subject.Node + "`, and this is `" + node + "`";
    }
    if (_isRevoked)
    {
        return file + " is revoked; `rabit keys renew` makes a new one";
    }
    if (HasSmallGuid(_subject) != WantsSmallGuid(transport))
    {
        return file + " was made for another DDS implementation than `" + transport +
               "`: with it, nodes of the other one would not be found; `rabit keys renew` with the "
               "configuration makes one that fits";
    }
    const bool isInDomain = std::any_of(_permissions.Rules.begin(), _permissions.Rules.end(),
                                        [domain](const Keys::Permissions::Rule &rule)
                                        { return rule.Allows && rule.IsIn(domain); });
    return isInDomain ? "" : _files.Permissions + " is not for domain " + std::to_string(domain);
}

std::vector<std::string> NodeKeys::Lacks(const Access &access) const
{
    std::vector<std::string> lacks;
    for (const TopicAccess &topic : access.Publish)
    {
        if (!_permissions.MayPublish(access.Domain, topic))
        {
            lacks.push_back(WordsFor("write", topic));
        }
    }
    for (const TopicAccess &topic : access.Subscribe)
    {
        if (!_permissions.MaySubscribe(access.Domain, topic))
        {
            lacks.push_back(WordsFor("read", topic));
        }
    }
    return lacks;
}

}  // namespace Rabit::Keys
