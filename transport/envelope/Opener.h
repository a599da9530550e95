#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "envelope/Aead.h"
#include "envelope/Claim.h"
#include "envelope/EpochSecrets.h"
#include "envelope/Outer.h"
#include "envelope/OwnChallenges.h"
#include "envelope/ProcessorBudget.h"
#include "envelope/Self.h"
#include "envelope/SessionTable.h"

namespace Rabit::Envelope
{

// Why a datagram was not opened, in the order of the checks.
enum class OpenFault : std::uint8_t
{
    None,
    Malformed,  // OuterFault tells why, or a claim's introduction does not fit its tag
    Own,        // sent by this session: multicast comes back
    UnknownEpoch,
    OldEpoch,            // a former one, of which bulletins alone are opened
    UnknownSession,      // no claim was heard
    Revoked,             // the sender's certificate
    Replayed,            // the number was taken
    TooOld,              // the number is below the window, or not above those of a displaced session
    NotFresh,            // of a session that has to prove first that it is live: no bulletin
    UnknownHeader,       // the session has no such RTPS header
    NotAuthentic,        // the tag: another key, receiver or content
    BadClaim,            // a claim's plaintext
    UnknownCertificate,  // the claim only names it, and no session has it. Ask for it
    OverBudget,          // its kind of sender has used up its processor time. Of a claim also before the tag,
                         // and in place of UnknownEpoch, OldEpoch, UnknownSession and NotFresh
    BadSignature,        // of the datagram: another member made it
    BadCertificate,      // not signed by the authority
    ForeignSource,       // INFO_SRC names a sender that the session does not bind, or the message has
                         // submessages that two parsers could divide differently
    RefusedClaim,        // ClaimVerdict tells why
    OpenSslFailed
};
constexpr std::size_t OpenFaults = static_cast<std::size_t>(OpenFault::OpenSslFailed) + 1;

// Opens the datagrams that come on one path. Order: header, window, freshness, AEAD, signature. A number is
// looked up first, and marked once tag and signature are right; nothing is remembered of a datagram of which
// they are not. Does not allocate, but for claims, and what OpenSSL allocates to verify a signature. Time is
// passed in. Not thread-safe: the lock of opening guards it, with its `SessionTable` and `OwnChallenges`. It
// touches nothing that `Sealer` changes.
class Opener
{
public:
    // Processor time in each second for signatures of strangers and of sessions that are not fresh. Claims
    // that answer this node's nonce have a half of their own: no recording can use it up.
    static constexpr std::chrono::milliseconds StrangersShare{10};
    static constexpr std::chrono::milliseconds AnswersShare{10};
    // For the keys of claims by which unknown sessions introduce themselves: anybody can send these.
    static constexpr std::chrono::milliseconds IntroductionsShare{20};
    // For what follows from datagrams of unknown sessions and epochs, and of sessions that are not fresh,
    // once for each of the two. Anybody can send these, too: beyond the share each of them costs a look-up
    // alone.
    static constexpr std::chrono::milliseconds ReactionsShare{10};
    // For bad signatures in the names of fresh sessions, once for the newest epoch and once for former ones.
    // Good ones cost nothing.
    static constexpr std::chrono::milliseconds ForgeriesShare{10};

    struct Result
    {
        OpenFault Fault = OpenFault::None;
        OuterClass Class = OuterClass::Traffic;
        // The whole RTPS message, its header restored, in the opener's memory until the next call. Empty for
        // claims. Give a datagram of the classes Meeting and Bulletin to no parser of a vendor.
        std::span<std::uint8_t> Message{};
        // The sender; after a fault, the session that the datagram names, which anybody may have sent. Null:
        // none.
        Session *Sender = nullptr;
        // Of a claim that was verified, refused or not.
        std::optional<ClaimVerdict> Verdict{};
        // Of a claim whose tag is right; zero: none. Answer it. After OverBudget nothing else is
        // known of its sender.
        Nonce Challenge{};
        Hash Wanted{};           // with UnknownCertificate: the hash of that certificate
        std::string Claimant{};  // with RefusedClaim: the names in both certificates
        std::string Holder{};
    };

    // All must outlive the opener.
    Opener(const Self &self, VerifyingKey &authority, const EpochSecrets &epochs,
           const OwnChallenges &challenges, SessionTable &sessions);

    // Opens a datagram. Accepts any bytes.
    Result Open(std::span<const std::uint8_t> datagram, TimePoint now);

    // How many datagrams ended so; with OpenFault::None, how many were opened.
    std::uint64_t Count(OpenFault fault) const { return _counts[static_cast<std::size_t>(fault)]; }

private:
    static OpenFault Asking(OpenFault fault, ProcessorBudget &budget, TimePoint now);
    Result OpenAny(std::span<const std::uint8_t> datagram, TimePoint now);
    Result OpenOfSession(std::span<const std::uint8_t> datagram, const Outer &outer, Session &session,
                         TimePoint now);
    Result OpenClaim(std::span<const std::uint8_t> datagram, const Outer &outer, TimePoint now);
    // Decrypts into the work space, behind the context. Returns the size of the plaintext with its signature.
    std::optional<std::size_t> Decrypt(std::span<const std::uint8_t> datagram, const Outer &outer,
                                       std::uint64_t number, const End &sender, const RtpsHeader &left,
                                       const SecretKey &key);
    bool HasGoodSignature(std::size_t size, VerifyingKey &key);
    // Verify the signature of what Decrypt left: None, OverBudget or BadSignature.
    OpenFault CheckOfFresh(std::size_t size, Session &session, Epoch epoch, TimePoint now);
    OpenFault CheckOfOther(std::size_t size, VerifyingKey &key, ProcessorBudget &budget, TimePoint now);
    const SecretKey *KeyOf(const Outer &outer, Session &session);

    const Self &_self;
    VerifyingKey &_authority;
    const EpochSecrets &_epochs;
    const OwnChallenges &_challenges;
    SessionTable &_sessions;
    SessionTag _ownTag;
    Aead _aead;
    ProcessorBudget _strangers{StrangersShare, ProcessorBudget::Signature};
    ProcessorBudget _answers{AnswersShare, ProcessorBudget::Signature};
    ProcessorBudget _introductions{IntroductionsShare, ProcessorBudget::Derivation};
    ProcessorBudget _unknown{ReactionsShare, ProcessorBudget::Reaction};
    ProcessorBudget _silent{ReactionsShare, ProcessorBudget::Reaction};
    ProcessorBudget _forgeries{ForgeriesShare, ProcessorBudget::Signature};
    ProcessorBudget _formerForgeries{ForgeriesShare, ProcessorBudget::Signature};
    std::vector<std::uint8_t> _work;
    std::array<std::uint64_t, OpenFaults> _counts{};
};

}  // namespace Rabit::Envelope
