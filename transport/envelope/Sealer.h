#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "envelope/Aead.h"
#include "envelope/Claim.h"
#include "envelope/EpochSecrets.h"
#include "envelope/Outer.h"
#include "envelope/Receiver.h"
#include "envelope/Self.h"

namespace Rabit::Envelope
{

enum class SealFault : std::uint8_t
{
    None,
    NotOurs,             // it begins with no RTPS header of this session (Self::Headers)
    TooLarge,            // sealed, it would be larger than a datagram
    NoRoom,              // the buffer is too small: Sealer::MostAdded
    NoEpoch,             // no epoch is known, or it is a former one and no bulletin
    NumbersEnded,        // a new session is needed
    EndsLikeStatistics,  // each of several tries ends in what Fast DDS would write over
    OpenSslFailed
};

// Seals the datagrams of one session. A datagram is a whole RTPS message, without statistics of Fast DDS
// (SizeWithoutStatistics). Does not allocate, but for what OpenSSL allocates in a signature. Not thread-safe:
// the lock of sealing guards it (Self.h). It touches nothing that `Opener` or `SessionTable` change.
class Sealer
{
public:
    // Room that a sealed datagram needs beyond the RTPS message. 91 without the RTPS header of 20; and
    // padding.
    static constexpr std::size_t MostTries = 8;
    static constexpr std::size_t PadSize = Rtps::SubmessageHeaderSize;
    static constexpr std::size_t MostAdded =
        OuterSize + sizeof(Signature) + TagSize - Rtps::RtpsHeaderSize + (MostTries - 1) * PadSize;
    static constexpr std::size_t LargestClaim =
        OuterSize + IntroductionSize + sizeof(Signature) + TagSize + 1024;

    struct Result
    {
        SealFault Fault = SealFault::None;
        std::size_t Size = 0;  // of the sealed datagram, if there is no fault
    };

    // Both must outlive the sealer.
    Sealer(Self &self, const EpochSecrets &epochs);

    // Group mode, for all. `epoch`: in which epoch a bulletin is sent to a node that has not got a newer one;
    // else the newest.
    Result SealGroup(std::span<const std::uint8_t> message, OuterClass contents, std::span<std::uint8_t> out,
                     std::optional<Epoch> epoch = std::nullopt);
    // Pairwise mode, for one session alone, which should be proven. In the epoch of `to`: the newest, or that
    // of a node to which a bulletin is sent.
    Result SealPairwise(std::span<const std::uint8_t> message, OuterClass contents, const Receiver &to,
                        std::span<std::uint8_t> out);
    // A claim of this session, with all its headers. `out`: LargestClaim bytes at most. `withCertificate`:
    // some receiver may not know it. `epoch`: a former one, in which a node sends that lacks a bulletin; else
    // the newest.
    Result SealClaim(const Nonce &challenge, std::span<const Nonce> answers, bool withCertificate,
                     std::span<std::uint8_t> out, std::optional<Epoch> epoch = std::nullopt);

    // The number of the next datagram. Numbers are never used twice, nor where a try failed.
    std::uint64_t Next() const { return _self.Next; }

private:
    struct Request
    {
        OuterKind Kind = OuterKind::Group;
        OuterClass Contents = OuterClass::Traffic;
        Envelope::Epoch Epoch = 0;
        SessionId Receiver = AllSessions;
        std::uint8_t Header = 0;
        const SecretKey *Key = nullptr;
    };

    bool MaySealIn(Epoch epoch, OuterClass contents) const;
    Result SealMessage(std::span<const std::uint8_t> message, Request request, std::span<std::uint8_t> out);
    // Seals `size` bytes, which are in the work space behind the context.
    Result SealTries(const Request &request, std::size_t size, std::span<std::uint8_t> out);
    SealFault SealOnce(const Request &request, std::uint64_t number, std::size_t size,
                       std::span<std::uint8_t> out);
    const SecretKey *OwnGroupKey(Epoch epoch);
    bool MayPad(std::size_t size) const;

    Self &_self;
    const EpochSecrets &_epochs;
    SessionTag _tag;
    Aead _aead;
    // The context, the plaintext, a signature.
    std::vector<std::uint8_t> _work;
    Epoch _keyEpoch = 0;
    std::optional<SecretKey> _key;
};

// True if Fast DDS would write its statistics over the end of these bytes: its sockets check one byte, 60
// before the end, of whatever they send.
bool LooksLikeStatistics(std::span<const std::uint8_t> datagram);

}  // namespace Rabit::Envelope
