// The keys of a fleet that follow from names alone: everybody can make them. For simulations and tests, in
// which another process can make the same ones. They must never protect a real fleet.
#pragma once

#include <rabit/transport/FleetMember.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "envelope/AgreementKey.h"
#include "envelope/Bulletin.h"
#include "envelope/Certificate.h"
#include "envelope/KeyDerivation.h"
#include "envelope/Permissions.h"
#include "envelope/SecretKey.h"
#include "envelope/SigningKey.h"

namespace Rabit::Envelope
{

// The authority of one fleet. Members of one fleet hear each other. Fleets with different names are strangers
// to each other. Not thread-safe.
class NamedKeys
{
public:
    using Rule = Envelope::Permissions::Rule;
    using Rules = std::vector<Rule>;
    using Names = std::vector<std::string>;

    explicit NamedKeys(std::string fleet = "fleet")
        : _fleet(std::move(fleet)), _authority(*Envelope::SigningKey::Of(SeedOf("authority", "")))
    {
    }

    static Rules Everything() { return {{.Topic = "*", .MayWrite = true, .MayRead = true}}; }

    // The keys of a node, with a bulletin of epoch 1 that has the secret for this node alone: the secret is
    // the same for all.
    MemberKeys KeysOf(const std::string &node, const Rules &rules = Everything(),
                      Envelope::CertificateRole role = Envelope::CertificateRole::Node)
    {
        MemberKeys keys;
        keys.SigningKey = SeedOf("signing", node).Bytes();
        keys.AgreementKey = SeedOf("agreement", node).Bytes();
        keys.Permissions = Envelope::Permissions::Of(rules)->Bytes();
        keys.Certificate = Envelope::WriteCertificate(
            {.Name = node,
             .Role = role,
             .Number = SerialOf(node),
             .Begins = 1'700'000'000,
             .Ends = 4'000'000'000,
             .Signing = Envelope::SigningKey::Of(SeedOf("signing", node))->Public(),
             .Agreement = AgreementOf(node),
             .Permissions = Envelope::Permissions::HashOf(keys.Permissions)},
            _authority);
        keys.Authority = _authority.Public();
        keys.Bulletins = {Bulletin(1, {node})};
        keys.Store = [](std::uint16_t, std::span<const std::uint8_t>) { return true; };
        return keys;
    }

    // A bulletin of an epoch, with its secret for these nodes.
    std::vector<std::uint8_t> Bulletin(Envelope::Epoch epoch, const Names &nodes, const Names &revoked = {})
    {
        std::vector<Envelope::Serial> ended;
        for (const std::string &node : revoked)
        {
            ended.push_back(SerialOf(node));
        }
        std::string once = std::to_string(epoch);
        std::vector<Envelope::BulletinNode> remaining;
        for (const std::string &node : nodes)
        {
            once += " " + node;
            remaining.push_back({.Number = SerialOf(node), .Agreement = AgreementOf(node)});
        }
        return Envelope::Bulletin::Write(epoch, ended, remaining, SeedOf("epoch", std::to_string(epoch)),
                                         *Envelope::AgreementKey::Of(SeedOf("once", once)), _authority);
    }

private:
    // 32 bytes that differ for each fleet, purpose and name.
    Envelope::SecretKey SeedOf(const std::string &purpose, const std::string &name) const
    {
        const std::string text = _fleet + "\n" + purpose + "\n" + name;
        const std::vector<std::uint8_t> bytes(text.begin(), text.end());
        return Envelope::SecretKey(Envelope::Sha256(bytes));
    }
    Envelope::PublicKey AgreementOf(const std::string &node) const
    {
        return Envelope::AgreementKey::Of(SeedOf("agreement", node))->Public();
    }
    Envelope::Serial SerialOf(const std::string &node) const
    {
        Envelope::Serial serial = 0;
        const Envelope::SecretKey seed = SeedOf("serial", node);
        std::for_each_n(seed.Bytes().begin(), sizeof(serial),
                        [&](std::uint8_t byte) { serial = serial << 8 | byte; });
        return serial;
    }

    const std::string _fleet;
    Envelope::SigningKey _authority;
};

}  // namespace Rabit::Envelope
