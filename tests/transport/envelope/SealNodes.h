// Nodes with keys, whose datagrams go from one to the other by hand. All keys are fixed, so all bytes are.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "envelope/Bulletin.h"
#include "envelope/Opener.h"
#include "envelope/Permissions.h"
#include "envelope/Sealer.h"

namespace SealNodes
{

using namespace Rabit::Envelope;
using Bytes = std::vector<std::uint8_t>;

constexpr TimePoint Start{std::chrono::hours(1)};
constexpr std::size_t Prefix = Rabit::Rtps::PrefixAt;

// 32 bytes that differ for each purpose and node.
inline SecretKey SeedOf(std::uint8_t purpose, std::uint8_t node)
{
    SecretKey seed;
    for (std::size_t i = 0; i < seed.Room().size(); ++i)
    {
        seed.Room()[i] = static_cast<std::uint8_t>(17 * i + 59 * purpose + node);
    }
    return seed;
}

inline const SecretKey FirstSecret = SeedOf(1, 0);
inline const SecretKey SecondSecret = SeedOf(1, 1);

// The header of an RTPS 2.3 message of that node. `vendor`: 0x0f Fast DDS.
inline RtpsHeader HeaderOf(std::uint8_t node, std::uint8_t vendor = 0x0f)
{
    return {'R', 'T', 'P', 'S', 2, 3, 1, vendor, 1, 15, node, node, 0, 0, 0, 0, 0, 0, 0, node};
}

// A whole RTPS message: the header, and one DATA submessage with so many bytes behind its header.
inline Bytes MessageOf(const RtpsHeader &header, std::size_t size = 128)
{
    Bytes message(header.begin(), header.end());
    message.insert(message.end(),
                   {0x15, 0x05, static_cast<std::uint8_t>(size), static_cast<std::uint8_t>(size >> 8)});
    for (std::size_t i = 0; i < size; ++i)
    {
        message.push_back(static_cast<std::uint8_t>(i));
    }
    return message;
}

struct Authority
{
    SigningKey Signing = *SigningKey::Of(SeedOf(2, 0));
    VerifyingKey Verifying = *VerifyingKey::Of(Signing.Public());

    Bytes Certify(const std::string &name, std::uint8_t node, Serial number,
                  CertificateRole role = CertificateRole::Node)
    {
        const Bytes list = Permissions::Of({{.Topic = "*", .MayWrite = true, .MayRead = true}})->Bytes();
        return WriteCertificate({.Name = name,
                                 .Role = role,
                                 .Number = number,
                                 .Begins = 1'700'000'000,
                                 .Ends = 2'000'000'000,
                                 .Signing = SigningKey::Of(SeedOf(3, node))->Public(),
                                 .Agreement = AgreementKey::Of(SeedOf(4, node))->Public(),
                                 .Permissions = Permissions::HashOf(list)},
                                Signing);
    }
};

inline SessionId SessionOf(std::uint8_t node, std::uint8_t opening)
{
    SessionId session{};
    for (std::size_t i = 0; i < session.size(); ++i)
    {
        session[i] = static_cast<std::uint8_t>(7 * i + 31 * node + 101 * opening + 3);
    }
    return session;
}

// A node in one session. `node` gives its keys, serial and RTPS headers.
class Node
{
public:
    // `next`: the number of its first datagram.
    Node(Authority &authority, std::string name, std::uint8_t node, std::uint8_t opening = 0,
         std::uint64_t next = 0, std::vector<RtpsHeader> headers = {})
        : Name(std::move(name)),
          Me(*Self::Of(
              SeedOf(3, node), SeedOf(4, node), SessionOf(node, opening), authority.Certify(Name, node, node),
              headers.empty() ? std::vector<RtpsHeader>{HeaderOf(node), HeaderOf(node, 0x62)} : headers)),
          Sessions(Me.Own, Name, Me.Headers),
          Seals(Me, Epochs),
          Opens(Me, authority.Verifying, Epochs, Challenges, Sessions),
          _node(node),
          _opening(opening)
    {
        Me.Next = next;
        Epochs.Learn(1, FirstSecret, {}, Start);
        Challenges.Set(NonceOf(), Start);
    }

    Nonce NonceOf() const { return {1, 2, 3, 4, _node, _opening, 7, _asked}; }
    // Asks for new proofs.
    void Ask(TimePoint now)
    {
        ++_asked;
        Challenges.Set(NonceOf(), now);
    }

    Bytes Claims(const std::vector<Nonce> &answers = {}, bool withCertificate = true)
    {
        return Taken([&](auto out) { return Seals.SealClaim(NonceOf(), answers, withCertificate, out); });
    }
    Bytes ToAll(const Bytes &message, OuterClass contents = OuterClass::Traffic)
    {
        return Taken([&](auto out) { return Seals.SealGroup(message, contents, out); });
    }
    Bytes Pairwise(const Bytes &message, const Node &to, OuterClass contents = OuterClass::Traffic)
    {
        return Taken([&](auto out) { return Seals.SealPairwise(message, contents, ReceiverOf(to), out); });
    }
    Session &Known(const Node &other) const
    {
        Session *const found = Sessions.Find(TagOf(other.Me.Own));
        if (found == nullptr)
        {
            throw std::logic_error(Name + " does not know " + other.Name);
        }
        return *found;
    }
    // In the newest epoch.
    Receiver ReceiverOf(const Node &other) const
    {
        const Epoch epoch = Epochs.Newest();
        return Known(other).ReceiverIn(epoch, *Epochs.Secret(epoch), Me.Agreement, Me.Own).value();
    }
    // Takes the claim of another node that answers this node's nonce.
    void Meet(Node &other, TimePoint now = Start)
    {
        if (Opens.Open(other.Claims({NonceOf()}), now).Verdict != ClaimVerdict::Proven)
        {
            throw std::logic_error(Name + " does not take the claim of " + other.Name);
        }
    }
    OpenFault Fault(const Bytes &datagram, TimePoint now = Start) { return Opens.Open(datagram, now).Fault; }
    Bytes Message(std::size_t size = 128) const { return MessageOf(Me.Headers[0], size); }

    // Seals into a buffer of the largest size. Throws if there is a fault.
    template <typename Seal>
    static Bytes Taken(const Seal &seal)
    {
        Bytes out(LargestDatagram);
        const Sealer::Result result = seal(std::span(out));
        if (result.Fault != SealFault::None)
        {
            throw std::runtime_error("sealing failed: " + std::to_string(static_cast<int>(result.Fault)));
        }
        out.resize(result.Size);
        return out;
    }

    std::string Name;
    Self Me;
    EpochSecrets Epochs;
    OwnChallenges Challenges;
    SessionTable Sessions;
    Sealer Seals;
    Opener Opens;

private:
    std::uint8_t _node;
    std::uint8_t _opening;
    std::uint8_t _asked = 0;
};

// Three nodes that have met: each is proven to each.
struct Three
{
    Authority Signs;
    Node A{Signs, "uav1", 1};
    Node B{Signs, "uav2", 2};
    Node C{Signs, "ground", 3};

    Three()
    {
        for (Node *each : {&A, &B, &C})
        {
            for (Node *other : {&A, &B, &C})
            {
                if (each != other)
                {
                    each->Meet(*other);
                }
            }
        }
    }
};

// A datagram for all that a member made in another's name: right but for its signature. All
// members know the epoch's secret, and so the other's key of group mode.
inline Bytes ForgedGroup(Node &member, const Node &as, std::uint64_t number, Epoch epoch = 1,
                         const SecretKey &secret = FirstSecret)
{
    const SecretKey key = GroupKey(secret, epoch, as.Me.Own).value();
    const Bytes message = as.Message();
    Bytes datagram(message.size() + 71);
    WriteOuter({.Epoch = epoch, .Tag = TagOf(as.Me.Own), .Number = static_cast<std::uint32_t>(number)},
               datagram);
    Bytes work(OuterContextSize);
    WriteOuterContext(datagram, number, as.Me.Own, AllSessions, as.Me.Headers[0], work);
    work.insert(work.end(), message.begin() + 20, message.end());
    const Signature signature = member.Me.Signing.Sign(work).value();
    work.insert(work.end(), signature.begin(), signature.end());
    if (!Aead().Seal(key, number, std::span(work).first(OuterContextSize),
                     std::span(work).subspan(OuterContextSize), std::span(datagram).subspan(OuterSize)))
    {
        throw std::runtime_error("sealing failed");
    }
    return datagram;
}

inline Bytes BytesOf(std::span<const std::uint8_t> bytes)
{
    return {bytes.begin(), bytes.end()};
}

}  // namespace SealNodes
