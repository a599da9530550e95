#include "envelope/Opener.h"

#include <algorithm>
#include <utility>

#include "guard/RtpsMessage.h"

namespace Rabit::Envelope
{

namespace
{

OpenFault FaultOf(ReplayWindow::Verdict verdict)
{
    return verdict == ReplayWindow::Verdict::New    ? OpenFault::None
           : verdict == ReplayWindow::Verdict::Seen ? OpenFault::Replayed
                                                    : OpenFault::TooOld;
}

// True if each INFO_SRC names a participant that the session binds. Walks as the guard does: a message of
// which two parsers could disagree where its submessages begin is refused.
bool SpeaksForItself(std::span<std::uint8_t> message, const Session &session)
{
    RtpsHeader source{};
    std::copy_n(message.begin(), source.size(), source.begin());
    auto rest = message.subspan(source.size());
    while (!rest.empty())
    {
        const auto part = Rtps::TakeSubmessage(rest);
        if (!part)
        {
            return false;
        }
        if (part->Kind == Rtps::SubmessageKind::InfoSource &&
            !(Rtps::PutSource(*part, source) && session.Binds(Rtps::SenderOf(source))))
        {
            return false;
        }
    }
    return true;
}

}  // namespace

Opener::Opener(const Self &self, VerifyingKey &authority, const EpochSecrets &epochs,
               const OwnChallenges &challenges, SessionTable &sessions)
    : _self(self),
      _authority(authority),
      _epochs(epochs),
      _challenges(challenges),
      _sessions(sessions),
      _ownTag(TagOf(self.Own)),
      _work(OuterContextSize + LargestDatagram)
{
}

Opener::Result Opener::Open(std::span<const std::uint8_t> datagram, TimePoint now)
{
    Result result = OpenAny(datagram, now);
    ++_counts[static_cast<std::size_t>(result.Fault)];
    return result;
}

// The fault of a datagram that is a reason to ask its sender.
OpenFault Opener::Asking(OpenFault fault, ProcessorBudget &budget, TimePoint now)
{
    return budget.Take(now) ? fault : OpenFault::OverBudget;
}

Opener::Result Opener::OpenAny(std::span<const std::uint8_t> datagram, TimePoint now)
{
    Outer outer;
    if (ReadOuter(datagram, outer) != OuterFault::None)
    {
        return {.Fault = OpenFault::Malformed};
    }
    if (outer.Tag == _ownTag)
    {
        return {.Fault = OpenFault::Own};
    }
    const EpochSecrets::Use use = _epochs.UseOf(outer.Epoch, now);
    if (use == EpochSecrets::Use::None)
    {
        return {.Fault = Asking(OpenFault::UnknownEpoch, _unknown, now)};
    }
    // A session is needed for a bulletin, too. So claims are opened in all epochs; they open nothing else.
    if (use == EpochSecrets::Use::Bulletin && outer.Class != OuterClass::Bulletin &&
        outer.Kind != OuterKind::Claim)
    {
        return {.Fault = Asking(OpenFault::OldEpoch, _unknown, now)};
    }
    if (outer.Kind == OuterKind::Claim)
    {
        return OpenClaim(datagram, outer, now);
    }
    Session *const session = _sessions.Find(outer.Tag);
    if (session == nullptr)
    {
        return {.Fault = Asking(OpenFault::UnknownSession, _unknown, now)};
    }
    return OpenOfSession(datagram, outer, *session, now);
}

Opener::Result Opener::OpenOfSession(std::span<const std::uint8_t> datagram, const Outer &outer,
                                     Session &session, TimePoint now)
{
    const auto refused = [&session](OpenFault fault) { return Result{.Fault = fault, .Sender = &session}; };
    if (_epochs.IsRevoked(session.Certificate().Content.Number))
    {
        return refused(OpenFault::Revoked);
    }
    const std::uint64_t number = session.Window().Restore(outer.Number);
    if (const OpenFault fault = FaultOf(session.Window().Look(number)); fault != OpenFault::None)
    {
        return refused(fault);
    }
    const bool isFresh = session.IsFresh(now);
    if (!isFresh && outer.Class != OuterClass::Bulletin)
    {
        return refused(Asking(OpenFault::NotFresh, _silent, now));
    }
    if (outer.Header >= session.Headers().size())
    {
        return refused(OpenFault::UnknownHeader);
    }
    const SecretKey *const key = KeyOf(outer, session);
    if (key == nullptr)
    {
        return refused(OpenFault::OpenSslFailed);
    }
    const auto opened =
        Decrypt(datagram, outer, number, session.Sender(), session.Headers()[outer.Header], *key);
    if (!opened)
    {
        return refused(OpenFault::NotAuthentic);
    }
    std::size_t size = *opened;
    if (outer.IsSigned())
    {
        const OpenFault fault = isFresh ? CheckOfFresh(size, session, outer.Epoch, now)
                                        : CheckOfOther(size, session.Certificate().Key, _strangers, now);
        if (fault != OpenFault::None)
        {
            return refused(fault);
        }
        size -= sizeof(Signature);
    }
    const auto message = std::span(_work).subspan(RtpsHeaderInContext, Rtps::RtpsHeaderSize + size);
    session.Window().Mark(number);
    if (!SpeaksForItself(message, session))
    {
        return refused(OpenFault::ForeignSource);
    }
    session.Hear(now);
    return {.Class = outer.Class, .Message = message, .Sender = &session};
}

Opener::Result Opener::OpenClaim(std::span<const std::uint8_t> datagram, const Outer &outer, TimePoint now)
{
    std::uint32_t high = 0;
    const End sender = ReadIntroduction(datagram, high);
    const std::uint64_t number = std::uint64_t{high} << 32 | outer.Number;
    Session *known = _sessions.Find(outer.Tag);
    known = known != nullptr && known->Sender() == sender ? known : nullptr;
    if (known != nullptr)
    {
        if (const OpenFault fault = FaultOf(known->Window().Look(number)); fault != OpenFault::None)
        {
            return {.Fault = fault, .Sender = known};
        }
    }
    // Nothing was hashed until here.
    else if (_sessions.WasTaken(sender, number))
    {
        return {.Fault = OpenFault::TooOld};
    }
    else if (!_introductions.Take(now))
    {
        return {.Fault = OpenFault::OverBudget};
    }
    else if (TagOf(sender) != outer.Tag)
    {
        return {.Fault = OpenFault::Malformed};
    }
    const auto refused = [known](OpenFault fault) { return Result{.Fault = fault, .Sender = known}; };
    const SecretKey &secret = *_epochs.Secret(outer.Epoch);
    const auto derived = known == nullptr ? GroupKey(secret, outer.Epoch, sender) : std::nullopt;
    const SecretKey *const key = known != nullptr ? known->GroupKeyOf(outer.Epoch, secret)
                                 : derived        ? &*derived
                                                  : nullptr;
    if (key == nullptr)
    {
        return refused(OpenFault::OpenSslFailed);
    }
    const auto size = Decrypt(datagram, outer, number, sender, RtpsHeader{}, *key);
    if (!size)
    {
        return refused(OpenFault::NotAuthentic);
    }
    const auto claim = ReadClaim(std::span(_work).subspan(OuterContextSize, *size - sizeof(Signature)));
    if (!claim)
    {
        return refused(OpenFault::BadClaim);
    }
    const std::optional<TimePoint> liveAt = _challenges.AnsweredBy(claim->Answers, now);
    ProcessorBudget &budget = liveAt ? _answers : _strangers;
    // The answer of this node has its nonce, and claims that answer that one have a budget of their own.
    const auto asksAlone = [&](OpenFault fault)
    {
        Result result = refused(fault);
        result.Challenge = claim->Challenge;
        return result;
    };

    std::shared_ptr<KnownCertificate> certificate =
        known != nullptr ? known->CertificateOwner() : _sessions.CertificateOf(sender.Certificate);
    const bool isNew = certificate == nullptr;
    if (isNew)
    {
        if (claim->Certificate.empty())
        {
            return {.Fault = OpenFault::UnknownCertificate, .Wanted = sender.Certificate};
        }
        const auto content = ReadCertificate(claim->Certificate);
        auto verifying = content ? VerifyingKey::Of(content->Signing) : std::nullopt;
        if (!verifying || Sha256(claim->Certificate) != sender.Certificate)
        {
            return refused(OpenFault::BadClaim);
        }
        certificate = std::make_shared<KnownCertificate>(
            KnownCertificate{.Hash = sender.Certificate, .Content = *content, .Key = std::move(*verifying)});
    }
    if (_epochs.IsRevoked(certificate->Content.Number))
    {
        return refused(OpenFault::Revoked);
    }
    const bool wasFresh = known != nullptr && known->IsFresh(now);
    const OpenFault fault = wasFresh ? CheckOfFresh(*size, *known, outer.Epoch, now)
                                     : CheckOfOther(*size, certificate->Key, budget, now);
    if (fault != OpenFault::None)
    {
        return fault == OpenFault::OverBudget ? asksAlone(fault) : refused(fault);
    }
    if (isNew)
    {
        if (!budget.Take(now))
        {
            return asksAlone(OpenFault::OverBudget);
        }
        if (!IsCertifiedBy(claim->Certificate, _authority))
        {
            return refused(OpenFault::BadCertificate);
        }
    }
    if (known != nullptr)
    {
        known->Window().Mark(number);
    }
    auto taken = _sessions.Take({.Sender = sender,
                                 .Certificate = certificate,
                                 .Headers = claim->Headers,
                                 .Number = number,
                                 .LiveAt = liveAt},
                                now);
    if (taken.Of == nullptr)
    {
        return {.Fault = OpenFault::RefusedClaim,
                .Verdict = taken.Verdict,
                .Claimant = certificate->Content.Name,
                .Holder = std::move(taken.Holder)};
    }
    if (known == nullptr)
    {
        taken.Of->Window().Mark(number);
    }
    // A claim that has just proven its session may be as old as the nonce.
    if (wasFresh)
    {
        taken.Of->Hear(now);
    }
    return {.Class = OuterClass::Meeting,
            .Sender = taken.Of,
            .Verdict = taken.Verdict,
            .Challenge = claim->Challenge};
}

std::optional<std::size_t> Opener::Decrypt(std::span<const std::uint8_t> datagram, const Outer &outer,
                                           std::uint64_t number, const End &sender, const RtpsHeader &left,
                                           const SecretKey &key)
{
    const SessionId &receiver = outer.Kind == OuterKind::Pairwise ? _self.Own.Session : AllSessions;
    const auto context = std::span(_work).first(OuterContextSize);
    WriteOuterContext(datagram, number, sender, receiver, left, context);
    const auto sealed = datagram.subspan(OuterSize + (outer.Kind == OuterKind::Claim ? IntroductionSize : 0));
    const std::size_t size = sealed.size() - TagSize;
    const bool good =
        _aead.Open(key, number, context, sealed, std::span(_work).subspan(OuterContextSize, size));
    return good ? std::optional(size) : std::nullopt;
}

bool Opener::HasGoodSignature(std::size_t size, VerifyingKey &key)
{
    const auto plain = std::span(_work).first(OuterContextSize + size);
    return key.Verify(plain.first(plain.size() - sizeof(Signature)), plain.last(sizeof(Signature)));
}

// All members have the key of a session's group mode, so each can cause this work in any session's name. The
// session in whose name it was caused pays for it, by datagrams that are not opened while the flood lasts.
OpenFault Opener::CheckOfFresh(std::size_t size, Session &session, Epoch epoch, TimePoint now)
{
    const bool isNewest = epoch == _epochs.Newest();
    ProcessorBudget &forgeries = isNewest ? _forgeries : _formerForgeries;
    if (session.IsSuspect(isNewest, now) && !forgeries.HasLeft(now))
    {
        return OpenFault::OverBudget;
    }
    if (HasGoodSignature(size, session.Certificate().Key))
    {
        return OpenFault::None;
    }
    forgeries.Take(now);
    session.Forge(isNewest, now);
    return OpenFault::BadSignature;
}

OpenFault Opener::CheckOfOther(std::size_t size, VerifyingKey &key, ProcessorBudget &budget, TimePoint now)
{
    if (!budget.Take(now))
    {
        return OpenFault::OverBudget;
    }
    return HasGoodSignature(size, key) ? OpenFault::None : OpenFault::BadSignature;
}

const SecretKey *Opener::KeyOf(const Outer &outer, Session &session)
{
    const SecretKey &secret = *_epochs.Secret(outer.Epoch);
    return outer.Kind == OuterKind::Pairwise
               ? session.KeyFrom(outer.Epoch, secret, _self.Agreement, _self.Own)
               : session.GroupKeyOf(outer.Epoch, secret);
}

}  // namespace Rabit::Envelope
