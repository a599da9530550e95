#include "envelope/SealingSide.h"

#include <utility>

namespace Rabit::Envelope
{

SealingSide::SealingSide(std::shared_ptr<const Member> member, Self &self)
    : _member(std::move(member)), _self(self), _sealer(self, _epochs)
{
}

void SealingSide::FollowEpochs()
{
    const std::uint64_t version = _member->EpochsVersion();
    if (version != _version)
    {
        _version = version;
        _epochs = _member->Epochs();
    }
}

SealFault SealingSide::Ended(const Sealer::Result &result, std::vector<std::uint8_t> &sealed)
{
    sealed.resize(result.Fault == SealFault::None ? result.Size : 0);
    return result.Fault;
}

SealFault SealingSide::Seal(std::span<const std::uint8_t> message, const std::optional<Rtps::Place> &to,
                            OuterClass contents, std::vector<std::uint8_t> &sealed)
{
    const std::lock_guard lock(_mutex);
    FollowEpochs();
    sealed.resize(message.size() + Sealer::MostAdded);
    const Receiver *const receiver = ReceiverAt(to);
    return Ended(receiver != nullptr ? _sealer.SealPairwise(message, contents, *receiver, sealed)
                                     : _sealer.SealGroup(message, contents, sealed),
                 sealed);
}

SealFault SealingSide::SealClaim(const ClaimExchange::Outgoing &claim, std::vector<std::uint8_t> &sealed)
{
    const std::lock_guard lock(_mutex);
    FollowEpochs();
    sealed.resize(Sealer::LargestClaim);
    return Ended(_sealer.SealClaim(claim.Challenge, claim.Answers, claim.WithCertificate, sealed, claim.In),
                 sealed);
}

SealFault SealingSide::SealBlob(const BlobExchange::Outgoing &blob, std::vector<std::uint8_t> &sealed)
{
    const std::lock_guard lock(_mutex);
    FollowEpochs();
    sealed.resize(blob.Message.size() + Sealer::MostAdded);
    return Ended(_sealer.SealGroup(blob.Message, OuterClass::Bulletin, sealed, blob.In), sealed);
}

// Null: the datagram is for several, or for a node that nobody may write to.
const Receiver *SealingSide::ReceiverAt(const std::optional<Rtps::Place> &to)
{
    const auto session = to ? _places.At(*to) : std::nullopt;
    const auto found = session ? _known.find(*session) : _known.end();
    return found == _known.end() || _epochs.IsRevoked(found->second.Of.Certificate().Content.Number)
               ? nullptr
               : ReceiverOf(found->second);
}

const Receiver *SealingSide::ReceiverOf(Known &known)
{
    const Epoch newest = _epochs.Newest();
    const SecretKey *const secret = _epochs.Secret(newest);
    if (secret != nullptr && (!known.To || known.To->Epoch != newest))
    {
        known.To = known.Of.ReceiverIn(newest, *secret, _self.Agreement, _self.Own);
    }
    return known.To ? &*known.To : nullptr;
}

void SealingSide::SetPlaces(const Session &session, SessionTag tag, std::span<const Rtps::Place> places,
                            const std::function<bool(SessionTag)> &isGone)
{
    const std::lock_guard lock(_mutex);
    FollowEpochs();
    if (_known.size() >= SessionPlaces::Most)
    {
        for (auto each = _known.begin(); each != _known.end();)
        {
            if (!isGone(each->first))
            {
                ++each;
                continue;
            }
            _places.Remove(each->first);
            each = _known.erase(each);
        }
    }
    auto found = _known.find(tag);
    if (found == _known.end() && _known.size() < SessionPlaces::Most)
    {
        // The agreement key is used now. Keys of later epochs follow from what it gave.
        Session copy(session.Sender(), session.CertificateOwner(), session.Headers(), TimePoint{});
        found = _known.emplace(tag, Known{.Of = std::move(copy)}).first;
        ReceiverOf(found->second);
    }
    if (found != _known.end())
    {
        _places.Set(tag, session.Sender().Certificate, places);
    }
}

}  // namespace Rabit::Envelope
