#include "envelope/SealedCore.h"

#include <rabit/base/Earliest.h>

#include <algorithm>
#include <utility>

#include "envelope/FaultText.h"
#include "envelope/KeyDerivation.h"

namespace Rabit::Envelope
{

namespace
{

ClaimExchange::Standing StandingOf(const Session *session)
{
    return session == nullptr    ? ClaimExchange::Standing::Unknown
           : session->IsProven() ? ClaimExchange::Standing::Proven
                                 : ClaimExchange::Standing::Claimed;
}

BlobExchange::Source SourceOf(const Outer &outer, const Session &sender)
{
    return {.Tag = outer.Tag, .In = outer.Epoch, .Number = sender.Certificate().Content.Number};
}

// A function of its own, since ThreadSanitizer's list of the vendors' buffers names it
// (tests/sanitizers/tsan.supp).
void PutOpened(std::span<const std::uint8_t> message, std::span<std::uint8_t> buffer)
{
    std::copy(message.begin(), message.end(), buffer.begin());
}

}  // namespace

std::unique_ptr<SealedCore> SealedCore::Make(std::shared_ptr<Member> member, std::vector<RtpsHeader> headers,
                                             Random random, TimePoint now)
{
    SessionId session{};
    auto authority = VerifyingKey::Of(member->Authority());
    if (!authority || !random(session) || session == AllSessions)
    {
        return nullptr;
    }
    auto self = member->SelfIn(session, std::move(headers));
    return self ? std::unique_ptr<SealedCore>(new SealedCore(std::move(member), std::move(*self),
                                                             std::move(*authority), std::move(random), now))
                : nullptr;
}

SealedCore::SealedCore(std::shared_ptr<Member> member, Self self, VerifyingKey authority, Random random,
                       TimePoint now)
    : _member(std::move(member)),
      _random(std::move(random)),
      _self(std::move(self)),
      _authority(std::move(authority)),
      _sessions(_self.Own, _member->Name(), _self.Headers),
      _claims([this] { return RandomNonce(); }),
      _opener(_self, _authority, _epochs, _claims.Challenges(), _sessions),
      _blobs(TagOf(_self.Own), _self.Headers.back(), _self.Own.Session.front()),
      _sealing(_member, _self)
{
    _blobs.SetOwn(BlobKind::Permissions, _member->Certificate().Permissions, _member->OwnList());
    FollowEpochs();
    _claims.Begin(now);
}

Nonce SealedCore::RandomNonce()
{
    Nonce nonce{};
    return _random(nonce) ? nonce : Nonce{};
}

void SealedCore::FollowEpochs()
{
    const std::uint64_t version = _member->EpochsVersion();
    if (version == _version)
    {
        return;
    }
    _version = version;
    _epochs = _member->Epochs();
    const auto newest = _member->Newest();
    _blobs.SetOwn(BlobKind::Bulletin, newest.Of, newest.Content);
    _sessions.EndRevoked(_epochs);
    _peers.EndIf([this](const BoundPeer &peer) { return _epochs.IsRevoked(peer.Number); });
}

bool SealedCore::Seal(std::span<const std::uint8_t> message, const std::optional<Rtps::Place> &to,
                      OuterClass contents, std::vector<std::uint8_t> &sealed, TimePoint now)
{
    // A member that announces another one's place must not keep back what tells whose it is.
    const bool isForAll = !to || !ReadAnnouncedPlaces(message).All.empty();
    const SealFault fault = _sealing.Seal(message, isForAll ? std::nullopt : to, contents, sealed);
    if (fault != SealFault::None)
    {
        _member->Note(_member->Name(), std::string("a datagram was not sent: ") + TextOf(fault), now);
    }
    return fault == SealFault::None;
}

std::span<std::uint8_t> SealedCore::Open(std::span<std::uint8_t> datagram, const Rtps::Place &from,
                                         TimePoint now)
{
    const std::lock_guard lock(_mutex);
    FollowEpochs();
    Outer outer;
    if (ReadOuter(datagram, outer) != OuterFault::None)
    {
        outer = {};
    }
    const Opener::Result result = _opener.Open(datagram, now);
    if (result.Fault != OpenFault::None)
    {
        TakeFault(result, datagram, outer, from, now);
        return {};
    }
    const Session &sender = *result.Sender;
    if (outer.Epoch < _epochs.Newest() && sender.IsFresh(now))
    {
        _blobs.Offer(outer.Epoch, now);
        _isNew = true;
    }
    if (result.Verdict || result.Class == OuterClass::Bulletin)
    {
        _pace.Heard(sender.Certificate().Content.Number, now);
        Await(outer.Tag, from, now);
        result.Verdict ? TakeClaim(result, outer, datagram.size(), now)
                       : TakeBlobs(result.Message, sender, outer, datagram.size(), now);
        return {};
    }
    Listen(sender, outer.Tag, now);
    const AnnouncedPlaces announced = ReadAnnouncedPlaces(result.Message);
    if (!announced.Discovery.empty())
    {
        _found.Put(outer.Tag, announced);
    }
    if (!IsReady(sender, SourceOf(outer, sender), now))
    {
        Await(outer.Tag, from, now);
        return {};
    }
    if (!announced.All.empty())
    {
        _sealing.SetPlaces(sender, outer.Tag, announced.All,
                           [this](SessionTag each) { return _sessions.Find(each) == nullptr; });
    }
    PutOpened(result.Message, datagram);
    return datagram.first(result.Message.size());
}

void SealedCore::Ask(const Session *session, SessionTag tag, Epoch in, TimePoint now)
{
    _claims.Heard(tag, StandingOf(session), in, now);
    _isNew = true;
}

void SealedCore::TakeClaim(const Opener::Result &result, const Outer &outer, std::size_t size, TimePoint now)
{
    _isNew = true;
    const Session &sender = *result.Sender;
    const Certificate &certificate = sender.Certificate().Content;
    const BlobExchange::Source source = SourceOf(outer, sender);
    _blobs.Drop(sender.Sender().Certificate);
    if (!sender.IsFresh(now))
    {
        _blobs.Credit(size);
        Ask(&sender, outer.Tag, outer.Epoch, now);
    }
    _claims.Asked(outer.Tag, StandingOf(&sender), result.Challenge, outer.Epoch, now);
    if (result.Verdict == ClaimVerdict::Proven)
    {
        _claims.Proven(outer.Tag, now);
        _member->NoteCertificate(certificate);
        IsReady(sender, source, now);
    }
    else if (!_member->ListOf(certificate.Permissions))
    {
        _blobs.Want(BlobKind::Permissions, certificate.Permissions, source, now);
    }
}

void SealedCore::TakeBlobs(std::span<const std::uint8_t> bytes, const Session &sender, const Outer &outer,
                           std::size_t size, TimePoint now)
{
    const auto message = ReadBlobMessage(bytes);
    if (!message)
    {
        return;
    }
    _isNew = true;
    const BlobExchange::Source source = SourceOf(outer, sender);
    const bool isFresh = sender.IsFresh(now);
    if (!isFresh)
    {
        _blobs.Credit(size);
    }
    for (const BlobRequest &request : message->Requests)
    {
        if (request.Of == TagOf(_self.Own) && request.Wanted == _self.Own.Certificate)
        {
            _claims.WantCertificate(outer.Epoch, now);
        }
    }
    if (message->Part && message->Part->Kind == BlobKind::Bulletin &&
        !_member->KnowsBulletin(message->Part->Of))
    {
        _blobs.Want(BlobKind::Bulletin, message->Part->Of, source, now);
    }
    auto blob = _blobs.Received(*message, source, isFresh, now);
    if (!blob)
    {
        return;
    }
    if (blob->Kind == BlobKind::Bulletin)
    {
        if (_arrived.size() < MostArrived)
        {
            _arrived.push_back(std::move(blob->Bytes));
        }
    }
    else if (!_member->AddList(blob->Of, blob->Bytes))
    {
        Log("the list of permissions of " + sender.Certificate().Content.Name + " is damaged");
    }
    else
    {
        _sessions.VisitAll(
            [&](const Session &each)
            {
                if (each.IsProven() && each.Certificate().Content.Permissions == blob->Of)
                {
                    IsReady(each,
                            {.Tag = TagOf(each.Sender()),
                             .In = outer.Epoch,
                             .Number = each.Certificate().Content.Number},
                            now);
                }
            });
    }
}

// True if the session's list of permissions is known. Its GUID prefixes are bound to its certificate then.
bool SealedCore::IsReady(const Session &session, const BlobExchange::Source &from, TimePoint now)
{
    if (_peers.Has(session))
    {
        return true;
    }
    const Hash &hash = session.Certificate().Content.Permissions;
    auto list = _member->ListOf(hash);
    const std::string &name = session.Certificate().Content.Name;
    if (list)
    {
        const bool isBound = _peers.Bind(session, from.Tag, std::move(list),
                                         [this](SessionTag tag) { return _sessions.Find(tag) == nullptr; });
        if (!isBound)
        {
            _member->Note(name, name + " is not listened to: another node had its identity before", now);
        }
        return isBound;
    }
    _blobs.Want(BlobKind::Permissions, hash, from, now);
    _member->Note(name, name + " is not listened to: its list of permissions does not come", now);
    _isNew = true;
    return false;
}

void SealedCore::Listen(const Session &sender, SessionTag tag, TimePoint now)
{
    const std::string &name = sender.Certificate().Content.Name;
    const auto verdict = _voices.Heard(name, tag, sender.Sender().Certificate, now);
    if (verdict != NodeVoices::Verdict::One)
    {
        _member->Note(name, TextOf(verdict, name), now);
    }
}

void SealedCore::Log(std::string line)
{
    if (_logs.size() < MostLogs)
    {
        _logs.push_back(std::move(line));
        _isNew = true;
    }
}

std::vector<std::string> SealedCore::TakeLogs()
{
    const std::lock_guard lock(_mutex);
    return std::exchange(_logs, {});
}

std::optional<TimePoint> SealedCore::LocalDue() const
{
    const std::lock_guard lock(_mutex);
    return _arrived.empty() && _logs.empty() ? std::nullopt : std::optional(TimePoint{});
}

std::optional<TimePoint> SealedCore::NetworkDue() const
{
    const std::lock_guard lock(_mutex);
    const auto due = Earliest({_claims.Due(), _blobs.Due()});
    return due ? std::optional(std::max(*due, _pace.Free())) : std::nullopt;
}

void SealedCore::Learn()
{
    std::vector<std::vector<std::uint8_t>> arrived;
    {
        const std::lock_guard lock(_mutex);
        arrived = std::exchange(_arrived, {});
    }
    std::vector<std::string> lines;
    for (auto &bulletin : arrived)
    {
        lines.push_back(_member->Learn(std::move(bulletin)));
    }
    const std::lock_guard lock(_mutex);
    for (std::string &line : lines)
    {
        if (!line.empty())
        {
            Log(std::move(line));
        }
    }
    FollowEpochs();
}

std::size_t SealedCore::DueBytes(TimePoint now)
{
    const std::lock_guard lock(_mutex);
    FollowEpochs();
    if (!_pace.IsFree(now))
    {
        return 0;
    }
    const auto claim = _claims.Next(_epochs.Newest(), now);
    const std::size_t blob = _blobs.DueBytes(now);
    if (blob > 0 && (_isBlobNext || !claim))
    {
        return SharedPace::IpAndUdp + OuterOverhead(OuterKind::Group) + blob - Rtps::RtpsHeaderSize;
    }
    return claim ? SharedPace::IpAndUdp + OuterOverhead(OuterKind::Claim) +
                       Claim::SizeWith(_self.Headers.size(), claim->Answers,
                                       claim->WithCertificate ? _self.Certificate.size() : 0)
                 : 0;
}

// Claims and messages of blobs take turns: claims that nobody answers would keep back all blobs.
std::optional<std::vector<std::uint8_t>> SealedCore::TakeDue(TimePoint now)
{
    const std::lock_guard lock(_mutex);
    FollowEpochs();
    if (!_pace.IsFree(now))
    {
        return std::nullopt;
    }
    auto blob = _isBlobNext ? _blobs.TakeDue(now) : std::nullopt;
    const auto claim = blob ? std::nullopt : _claims.TakeDue(_epochs.Newest(), now);
    if (!blob && !claim)
    {
        blob = _blobs.TakeDue(now);
    }
    if (!blob && !claim)
    {
        return std::nullopt;
    }
    _isBlobNext = claim.has_value();
    std::vector<std::uint8_t> sealed;
    const SealFault fault = claim ? _sealing.SealClaim(*claim, sealed) : _sealing.SealBlob(*blob, sealed);
    if (fault != SealFault::None)
    {
        _member->Note(_member->Name(), std::string("a claim was not sent: ") + TextOf(fault), now);
        return std::nullopt;
    }
    _pace.Take(sealed.size());
    return sealed;
}

SealedCore::Memory SealedCore::Remembered() const
{
    const std::lock_guard lock(_mutex);
    return {.Sessions = _sessions.Size(),
            .Others = _claims.Size() + _blobs.Wanted() + _blobs.Incomplete() + _peers.Size() +
                      _voices.Size() + _found.Size()};
}

bool SealedCore::IsOpenTo(const Rtps::GuidPrefix &prefix, TimePoint now) const
{
    const auto peer = _peers.Find(prefix);
    const std::lock_guard lock(_mutex);
    const Session *const session = peer ? _sessions.Find(peer->Session) : nullptr;
    return session != nullptr && session->IsFresh(now);
}

}  // namespace Rabit::Envelope
