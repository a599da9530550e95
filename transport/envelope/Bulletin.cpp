#include "envelope/Bulletin.h"

#include <rabit/base/LittleEndian.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "common/RtpsWriter.h"
#include "envelope/Aead.h"
#include "envelope/KeyDerivation.h"

namespace Rabit::Envelope
{

namespace
{

constexpr std::string_view BulletinLabel = "Rabit bulletin 1";
constexpr std::uint8_t BulletinFormat = 1;
constexpr std::size_t FixedBulletinSize = 39;
constexpr std::size_t SealedSecretSize = sizeof(SecretKey::Content) + TagSize;
constexpr std::size_t NodeEntrySize = sizeof(Serial) + SealedSecretSize;

std::vector<std::uint8_t> LabelledBulletin(std::span<const std::uint8_t> content)
{
    std::vector<std::uint8_t> labelled(BulletinLabel.begin(), BulletinLabel.end());
    Rtps::Append(labelled, content);
    return labelled;
}

std::optional<SecretKey> KeyForNode(Epoch epoch, const SecretKey &shared, const PublicKey &once,
                                    const BulletinNode &node)
{
    std::array<std::uint8_t, 2 * sizeof(PublicKey)> salt{};
    std::copy(once.begin(), once.end(), salt.begin());
    std::copy(node.Agreement.begin(), node.Agreement.end(), salt.begin() + sizeof(PublicKey));
    std::vector<std::uint8_t> info(BulletinLabel.begin(), BulletinLabel.end());
    LittleEndian::Put(epoch, info);
    LittleEndian::Put(node.Number, info);
    return Hkdf(salt, shared.Bytes(), info);
}

std::vector<std::uint8_t> AuthenticatedWithSecret(Epoch epoch, Serial number)
{
    std::vector<std::uint8_t> bytes;
    LittleEndian::Put(epoch, bytes);
    LittleEndian::Put(number, bytes);
    return bytes;
}

Serial SerialAt(std::span<const std::uint8_t> entries, std::size_t at)
{
    return LittleEndian::Read<Serial>(entries.subspan(at, sizeof(Serial)));
}

// True if the serials at the beginnings of all entries rise.
bool SerialsRise(std::span<const std::uint8_t> entries, std::size_t size)
{
    for (std::size_t at = size; at < entries.size(); at += size)
    {
        if (SerialAt(entries, at - size) >= SerialAt(entries, at))
        {
            return false;
        }
    }
    return true;
}

// Sorts. False if a serial occurs twice, or in both.
bool AreApart(std::vector<Serial> &revoked, std::vector<BulletinNode> &nodes)
{
    std::sort(revoked.begin(), revoked.end());
    std::sort(nodes.begin(), nodes.end(),
              [](const BulletinNode &a, const BulletinNode &b) { return a.Number < b.Number; });
    const auto isSame = [](const BulletinNode &a, const BulletinNode &b) { return a.Number == b.Number; };
    return std::adjacent_find(revoked.begin(), revoked.end()) == revoked.end() &&
           std::adjacent_find(nodes.begin(), nodes.end(), isSame) == nodes.end() &&
           std::none_of(nodes.begin(), nodes.end(),
                        [&revoked](const BulletinNode &node)
                        { return std::binary_search(revoked.begin(), revoked.end(), node.Number); });
}

}  // namespace

std::optional<Bulletin> Bulletin::Read(std::span<const std::uint8_t> bytes, VerifyingKey &authority)
{
    if (bytes.size() < FixedBulletinSize + sizeof(Signature) || bytes[0] != BulletinFormat)
    {
        return std::nullopt;
    }
    const auto content = bytes.first(bytes.size() - sizeof(Signature));
    Bulletin read;
    auto rest = content.subspan(1);
    read._epoch = LittleEndian::Take<Envelope::Epoch>(rest);
    std::copy_n(rest.begin(), read._once.size(), read._once.begin());
    rest = rest.subspan(read._once.size());
    const std::size_t revoked = LittleEndian::Take<std::uint16_t>(rest);
    const std::size_t nodes = LittleEndian::Take<std::uint16_t>(rest);
    if (read._epoch == 0 || revoked > MostRevoked || nodes > MostBulletinNodes ||
        rest.size() != revoked * sizeof(Serial) + nodes * NodeEntrySize)
    {
        return std::nullopt;
    }
    read._revoked = rest.first(revoked * sizeof(Serial));
    read._nodes = rest.subspan(read._revoked.size());
    if (!SerialsRise(read._revoked, sizeof(Serial)) || !SerialsRise(read._nodes, NodeEntrySize) ||
        !authority.Verify(LabelledBulletin(content), bytes.last(sizeof(Signature))))
    {
        return std::nullopt;
    }
    return read;
}

std::vector<std::uint8_t> Bulletin::Write(Envelope::Epoch epoch, std::vector<Serial> revoked,
                                          std::vector<BulletinNode> nodes, const SecretKey &secret,
                                          const AgreementKey &once, SigningKey &authority)
{
    if (epoch == 0 || revoked.size() > MostRevoked || nodes.size() > MostBulletinNodes ||
        !AreApart(revoked, nodes))
    {
        return {};
    }
    std::vector<std::uint8_t> bytes{BulletinFormat};
    LittleEndian::Put(epoch, bytes);
    Rtps::Append(bytes, once.Public());
    LittleEndian::Put(static_cast<std::uint16_t>(revoked.size()), bytes);
    LittleEndian::Put(static_cast<std::uint16_t>(nodes.size()), bytes);
    for (const Serial number : revoked)
    {
        LittleEndian::Put(number, bytes);
    }
    Aead aead;
    for (const BulletinNode &node : nodes)
    {
        const auto shared = once.SharedWith(node.Agreement);
        const auto key = shared ? KeyForNode(epoch, *shared, once.Public(), node) : std::nullopt;
        std::array<std::uint8_t, SealedSecretSize> sealed{};
        if (!key || !aead.Seal(*key, 0, AuthenticatedWithSecret(epoch, node.Number), secret.Bytes(), sealed))
        {
            return {};
        }
        LittleEndian::Put(node.Number, bytes);
        Rtps::Append(bytes, sealed);
    }
    const auto signature = authority.Sign(LabelledBulletin(bytes));
    if (!signature)
    {
        return {};
    }
    Rtps::Append(bytes, *signature);
    return bytes;
}

std::vector<Serial> Bulletin::Revoked() const
{
    std::vector<Serial> revoked;
    for (std::size_t at = 0; at < _revoked.size(); at += sizeof(Serial))
    {
        revoked.push_back(SerialAt(_revoked, at));
    }
    return revoked;
}

std::optional<SecretKey> Bulletin::Secret(Serial number, const AgreementKey &key) const
{
    for (std::size_t at = 0; at < _nodes.size(); at += NodeEntrySize)
    {
        if (SerialAt(_nodes, at) != number)
        {
            continue;
        }
        const auto shared = key.SharedWith(_once);
        const auto opening =
            shared ? KeyForNode(_epoch, *shared, _once, {number, key.Public()}) : std::nullopt;
        SecretKey secret;
        const bool good =
            opening && Aead().Open(*opening, 0, AuthenticatedWithSecret(_epoch, number),
                                   _nodes.subspan(at + sizeof(Serial), SealedSecretSize), secret.Room());
        return good ? std::optional(secret) : std::nullopt;
    }
    return std::nullopt;
}

}  // namespace Rabit::Envelope
