// SealedCore and datagrams that did not open: reactions, and where their senders are.
#include <string>
#include <utility>

#include "envelope/FaultText.h"
#include "envelope/SealedCore.h"

namespace Rabit::Envelope
{

void SealedCore::TakeFault(const Opener::Result &result, std::span<const std::uint8_t> datagram,
                           const Outer &outer, const Rtps::Place &from, TimePoint now)
{
    if (result.Fault == OpenFault::UnknownEpoch && outer.Epoch == EpochOfCalls)
    {
        AnswerCall(now);
        return;
    }
    NoteRow(result, datagram, outer, from, now);
    switch (result.Fault)
    {
        case OpenFault::UnknownEpoch:
            // The sender hears that this node lacks the newest bulletin.
            if (outer.Epoch > _epochs.Newest())
            {
                Await(outer.Tag, from, now);
                Ask(nullptr, outer.Tag, _epochs.Newest(), now);
            }
            return;
        case OpenFault::OldEpoch:
            if (const Session *known = _sessions.Find(outer.Tag); known == nullptr || !known->IsFresh(now))
            {
                Await(outer.Tag, from, now);
                Ask(known, outer.Tag, outer.Epoch, now);
            }
            return;
        case OpenFault::UnknownSession:
        case OpenFault::NotFresh:
            Await(outer.Tag, from, now);
            Ask(result.Sender, outer.Tag, outer.Epoch, now);
            return;
        case OpenFault::UnknownCertificate:
            Await(outer.Tag, from, now);
            _blobs.Want(BlobKind::Certificate, result.Wanted, {.Tag = outer.Tag, .In = outer.Epoch}, now);
            Ask(nullptr, outer.Tag, outer.Epoch, now);
            return;
        case OpenFault::OverBudget:
            // Of a claim whose tag is right. Others cost no more than that.
            if (result.Challenge != Nonce{})
            {
                Await(outer.Tag, from, now);
                _claims.Asked(outer.Tag, ClaimExchange::Standing::Unknown, result.Challenge, outer.Epoch,
                              now);
                _isNew = true;
            }
            return;
        case OpenFault::Revoked:
            _claims.Refuse(outer.Tag);
            return;
        case OpenFault::RefusedClaim:
            Refused(result);
            return;
        default:
            return;
    }
}

// Anybody can make calls, so they cause no row, and nobody is asked or answered.
void SealedCore::AnswerCall(TimePoint now)
{
    if (now >= _callsFrom)
    {
        _callsFrom = now + BetweenAnswersToCalls;
        _claims.WantCertificate(_epochs.Newest(), now);
        _isNew = true;
    }
}

void SealedCore::NoteRow(const Opener::Result &result, std::span<const std::uint8_t> datagram,
                         const Outer &outer, const Rtps::Place &from, TimePoint now)
{
    if (!_rows.HasLeft(now))
    {
        return;
    }
    const auto [entry, text, kind] = RowOf(result, datagram, outer.Epoch, _epochs.Newest(), from.Host);
    if (!text.empty())
    {
        _rows.Take(now);
        _member->Note(entry, text, now, kind);
    }
}

// A node that has announced itself is reached where it said, and is no stranger: strangers share an allowance
// (Ledger.h), which recordings of known nodes must not use up.
void SealedCore::Await(SessionTag tag, const Rtps::Place &from, TimePoint now)
{
    if (from.Host == Rtps::UnknownHost)
    {
        return;
    }
    const AnnouncedPlaces *const found = _found.Find(tag);
    const auto at = found != nullptr ? found->DiscoveryAt(from.Host) : std::nullopt;
    at ? _known.Heard(*at, now) : _strangers.Heard({.Host = from.Host, .Port = 0}, now);
}

std::vector<Rtps::Place> SealedCore::Strangers(TimePoint now)
{
    const std::lock_guard lock(_mutex);
    std::vector<Rtps::Place> places = _known.Current(now);
    for (const Rtps::Place &host : _strangers.Current(now))
    {
        places.push_back(host);
    }
    return places;
}

void SealedCore::Refused(const Opener::Result &result)
{
    if (result.Verdict == ClaimVerdict::TooMany || result.Claimant.empty())
    {
        return;
    }
    const std::string text = result.Claimant + " claims an identity that " + result.Holder + " has proven";
    // A member can claim again and again.
    if (_member->NoteCertain(result.Claimant, text))
    {
        Log(text);
    }
}

}  // namespace Rabit::Envelope
