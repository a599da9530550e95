#include "keys/MemberRequest.h"

#include <rabit/keys/KeysError.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "keys/Armour.h"
#include "keys/KeyFiles.h"
#include "keys/MemberFiles.h"
#include "keys/NodeFolders.h"
#include "keys/NodeName.h"

namespace Rabit::Keys
{
namespace
{

constexpr std::string_view RequestContext = "Rabit request 1";
constexpr std::uint8_t RequestFormat = 1;
constexpr std::size_t FixedRequestSize = 66;  // up to the name
constexpr std::size_t LargestRequestText = 16 * 1024;

Bytes InRequestContext(std::span<const std::uint8_t> content)
{
    Bytes bytes(RequestContext.begin(), RequestContext.end());
    bytes.insert(bytes.end(), content.begin(), content.end());
    return bytes;
}

// True if the authority could seal a secret to the key: it is no point of low order.
bool IsAgreementKey(const Envelope::PublicKey &key)
{
    return AgreementKeyOf(RandomSecret()).SharedWith(key).has_value();
}

}  // namespace

std::string MakeMemberRequest(const std::string &node, const MemberSecrets &secrets)
{
    CheckNodeName(node);
    const MemberPublic keys = MemberPublic::Of(secrets);
    Bytes bytes{RequestFormat};
    bytes.insert(bytes.end(), keys.Signing.begin(), keys.Signing.end());
    bytes.insert(bytes.end(), keys.Agreement.begin(), keys.Agreement.end());
    bytes.push_back(static_cast<std::uint8_t>(node.size()));
    bytes.insert(bytes.end(), node.begin(), node.end());
    const auto signature = SigningKeyOf(secrets.Signing).Sign(InRequestContext(bytes));
    if (!signature)
    {
        throw KeysError("cannot sign the request of " + node);
    }
    bytes.insert(bytes.end(), signature->begin(), signature->end());
    return Armoured(RequestLabel, bytes);
}

MemberRequest ReadMemberRequest(std::string_view text, const std::string &file)
{
    if (text.size() > LargestRequestText)
    {
        throw KeysError(file + " is larger than 16 KiB: no request of a node");
    }
    if (text.find("-----BEGIN CERTIFICATE REQUEST-----") != std::string_view::npos)
    {
        throw KeysError(file +
                        " is a request of a former format, which nothing reads any more; make another one "
                        "with `rabit keys request` in another folder of the node");
    }
    const Bytes bytes = BlockIn(text, RequestLabel, file);
    const std::span<const std::uint8_t> all(bytes);
    if (all.size() < FixedRequestSize || all[0] != RequestFormat ||
        all.size() != FixedRequestSize + all[FixedRequestSize - 1] + sizeof(Envelope::Signature))
    {
        throw KeysError(file + " is no request of a node, or of another version of this program");
    }
    MemberRequest request;
    const auto signing = all.subspan(1, sizeof(Envelope::PublicKey));
    const auto agreement = all.subspan(1 + signing.size(), sizeof(Envelope::PublicKey));
    std::copy(signing.begin(), signing.end(), request.Keys.Signing.begin());
    std::copy(agreement.begin(), agreement.end(), request.Keys.Agreement.begin());
    const auto name = all.subspan(FixedRequestSize, all[FixedRequestSize - 1]);
    request.Node.assign(name.begin(), name.end());
    const auto content = all.first(all.size() - sizeof(Envelope::Signature));
    if (!VerifyingKeyOf(request.Keys.Signing)
             .Verify(InRequestContext(content), all.last(sizeof(Envelope::Signature))))
    {
        throw KeysError(file + " is not signed by the key in it, or was changed; copy it again");
    }
    try
    {
        CheckNodeName(request.Node);
    }
    catch (const KeysError &error)
    {
        throw KeysError(file + ": " + error.what());
    }
    if (!IsAgreementKey(request.Keys.Agreement))
    {
        throw KeysError(file +
                        " has a key to which nothing can be sealed; make it with `rabit keys request`");
    }
    return request;
}

RequestedMember RequestMember(const std::string &folder, const std::string &node)
{
    CheckNodeName(node);
    CheckFormat(folder);
    if (std::filesystem::is_directory(folder + "/" + AuthorityFolder))
    {
        throw KeysError(folder + " has the authority of a fleet; name another folder for the node's keys");
    }
    if (!std::filesystem::exists(folder))
    {
        MakeSecretFolder(folder);
    }
    const std::string place = MemberFiles(folder).Key;
    if (!std::filesystem::exists(place))
    {
        WriteNewSecret(place, MemberSecrets::Random().Pem());
    }
    // Another program may have made the keys first.
    const MemberSecrets secrets = MemberSecrets::Read(ReadSecret(place), place);
    RequestedMember made{folder + "/" + node + ".request.pem", MemberPublic::Of(secrets).Fingerprint()};
    WriteFile(made.File, MakeMemberRequest(node, secrets));
    return made;
}

}  // namespace Rabit::Keys
