#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "envelope/AgreementKey.h"
#include "envelope/Certificate.h"
#include "envelope/EpochSecrets.h"
#include "envelope/KeyDerivation.h"
#include "envelope/Receiver.h"
#include "envelope/ReplayWindow.h"
#include "envelope/VerifyingKey.h"

namespace Rabit::Envelope
{

// A certificate that the authority signed.
struct KnownCertificate
{
    Envelope::Hash Hash{};
    Certificate Content;
    VerifyingKey Key;
};

// One session of another node, as this node knows it. Made from a claim that was verified. Not thread-safe:
// the lock of opening guards it (SessionTable). Sealing needs no more than a `Receiver`.
class Session
{
public:
    // A session that was silent for longer has to prove again that it is live: what comes may be a recording.
    static constexpr std::chrono::seconds SilenceAllowed{10};
    static constexpr std::chrono::seconds SuspectFor{10};

    Session(const End &sender, std::shared_ptr<KnownCertificate> certificate, std::vector<RtpsHeader> headers,
            TimePoint now)
        : _sender(sender), _certificate(std::move(certificate)), _headers(std::move(headers)), _heard(now)
    {
    }

    const End &Sender() const { return _sender; }
    KnownCertificate &Certificate() const { return *_certificate; }
    const std::shared_ptr<KnownCertificate> &CertificateOwner() const { return _certificate; }
    const std::vector<RtpsHeader> &Headers() const { return _headers; }
    bool Binds(const Rtps::GuidPrefix &prefix) const;

    // True if it ever proved that it is live.
    bool IsProven() const { return _proven; }
    // True if it did, and was never silent for long since.
    bool IsFresh(TimePoint now) const { return _proven && now - _heard <= SilenceAllowed; }
    // When it was heard last, as far as that was live; at first, when it was claimed.
    TimePoint Heard() const { return _heard; }
    // The datagram of this number proved that the sender lived at `at` or later. If it was not fresh, lower
    // numbers are refused from now on, since they may be recordings.
    void Prove(std::uint64_t number, TimePoint at, TimePoint now);
    // A verified datagram came. Without effect unless the session is fresh.
    void Hear(TimePoint now);

    // A datagram that a member made in this session's name had a bad signature. `inNewest`: it was of the
    // newest epoch. Former ones count apart, since revoked members know their secrets, too.
    void Forge(bool inNewest, TimePoint now) { _forged[inNewest ? 1 : 0] = now; }
    // True if Forge was called in the last SuspectFor.
    bool IsSuspect(bool inNewest, TimePoint now) const;

    ReplayWindow &Window() { return _window; }

    // Keys of what it sends, derived when they are first used: at most once for each epoch
    // (EpochSecrets::Most). Null if OpenSSL fails, or if the peer's public key is of low order.
    const SecretKey *GroupKeyOf(Epoch epoch, const SecretKey &secret);
    const SecretKey *KeyFrom(Epoch epoch, const SecretKey &secret, const AgreementKey &own, const End &self);
    // Returns a copy for `Sealer`, with the key of that epoch. Empty for the same reasons.
    std::optional<Receiver> ReceiverIn(Epoch epoch, const SecretKey &secret, const AgreementKey &own,
                                       const End &self);

private:
    struct EpochKeys
    {
        Epoch Of = 0;
        std::optional<SecretKey> Group;
        std::optional<SecretKey> From;
    };

    EpochKeys &KeysOf(Epoch epoch);
    const SecretKey *SharedWith(const AgreementKey &own);

    End _sender;
    std::shared_ptr<KnownCertificate> _certificate;
    std::vector<RtpsHeader> _headers;
    ReplayWindow _window;
    bool _proven = false;
    TimePoint _heard;
    std::array<std::optional<TimePoint>, 2> _forged{};  // in former epochs; in the newest
    bool _sharedTried = false;
    std::optional<SecretKey> _shared;
    std::array<EpochKeys, EpochSecrets::Most> _keys{};
};

}  // namespace Rabit::Envelope
