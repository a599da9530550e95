#include "envelope/BlobExchange.h"

#include <algorithm>
#include <utility>

#include "envelope/KeyDerivation.h"

namespace Rabit::Envelope
{

void BlobExchange::SetOwn(BlobKind kind, const Hash &hash,
                          std::shared_ptr<const std::vector<std::uint8_t>> bytes)
{
    OwnBlob &own = _owned[static_cast<std::size_t>(kind)];
    own.Of = hash;
    own.Parts.assign(bytes ? BlobPartsOf(bytes->size()) : 0, OwnPart{});
    own.Bytes = std::move(bytes);
}

std::chrono::milliseconds BlobExchange::ShareOf(std::chrono::milliseconds spread) const
{
    return spread * int{_spread} / 256;
}

void BlobExchange::Want(BlobKind kind, const Hash &hash, const Source &from, TimePoint now)
{
    auto found = _wanted.find(hash);
    if (found == _wanted.end())
    {
        DropIf(
            [&](const Lack &each)
            {
                return now - each.Named > Forgotten ||
                       (kind == BlobKind::Bulletin && each.Kind == kind && each.From.Number == from.Number);
            });
        const auto alike = std::count_if(_wanted.begin(), _wanted.end(),
                                         [kind](const auto &each) { return each.second.Kind == kind; });
        if (static_cast<std::size_t>(alike) >= MostWanted[static_cast<std::size_t>(kind)])
        {
            return;
        }
        found = _wanted.emplace(hash, Lack{}).first;
        found->second.Kind = kind;
        found->second.From = from;
        found->second.Progress = now;
        found->second.Since = now;
        found->second.Retry.Begin(now + Gather + ShareOf(RequestSpread));
    }
    Lack &lack = found->second;
    lack.Named = now;
    if (lack.From.Tag == from.Tag)
    {
        lack.From = from;
    }
    else if (MayReplace(lack, from, now))
    {
        Replace(lack, from, now);
    }
}

bool BlobExchange::MayReplace(const Lack &lack, const Source &from, TimePoint now)
{
    const int turns = lack.Tried.contains(from.Number) ? 2 : 1;
    return now - lack.Progress > turns * SourcePatience ||
           (from.Number != lack.From.Number && now - lack.Since > turns * lack.Turn);
}

void BlobExchange::Replace(Lack &lack, const Source &from, TimePoint now)
{
    // The parts may be wrong: they came from the former source.
    DropParts(lack);
    if (from.Number != lack.From.Number)
    {
        if (lack.Tried.size() < MostTried)
        {
            lack.Tried.insert(lack.From.Number);
        }
        lack.Since = now;
        lack.Turn = std::min(2 * lack.Turn, LongestTurn);
    }
    lack.From = from;
    lack.Progress = now;
    lack.Retry.Hasten(now + Gather);
}

void BlobExchange::Drop(const Hash &hash)
{
    if (const auto found = _wanted.find(hash); found != _wanted.end())
    {
        DropParts(found->second);
        _wanted.erase(found);
    }
}

template <typename Is>
void BlobExchange::DropIf(const Is &is)
{
    for (auto each = _wanted.begin(); each != _wanted.end();)
    {
        if (!is(std::as_const(each->second)))
        {
            ++each;
            continue;
        }
        DropParts(each->second);
        each = _wanted.erase(each);
    }
}

void BlobExchange::DropParts(Lack &lack)
{
    _incomplete -= std::exchange(lack.Bytes, 0);
    lack.Parts.clear();
    lack.Size = 0;
}

void BlobExchange::Offer(Epoch in, TimePoint now)
{
    auto found = _offers.find(in);
    if (found == _offers.end() && _offers.size() < MostOffers)
    {
        found = _offers.emplace(in, Offered{}).first;
        found->second.Timer.Begin(now + ShareOf(OfferSpread));
        found->second.Latest = now + ShareOf(OfferSpread) + LongestPostponed;
    }
    if (found != _offers.end())
    {
        found->second.Heard = now;
    }
}

void BlobExchange::Credit(std::size_t bytes)
{
    _credit = std::min(_credit + bytes, MostCredit);
}

std::optional<BlobExchange::Blob> BlobExchange::Received(const BlobMessage &message, const Source &from,
                                                         bool isProven, TimePoint now)
{
    for (const BlobRequest &request : message.Requests)
    {
        Take(request, from, isProven, now);
    }
    if (!message.Part)
    {
        return std::nullopt;
    }
    // Another session offers, or sends what somebody asked for.
    const OwnBlob &own = _owned[static_cast<std::size_t>(message.Part->Kind)];
    const auto offered = _offers.find(from.In);
    if (message.Part->Kind == BlobKind::Bulletin && message.Part->Of == own.Of && offered != _offers.end())
    {
        const TimePoint others = now + FirstOffer + ShareOf(OfferSpread);
        offered->second.Timer.Postpone(std::min(others, offered->second.Latest));
    }
    Keep(*message.Part, from, now);
    return Complete(message.Part->Of, now);
}

void BlobExchange::Keep(const BlobPart &part, const Source &from, TimePoint now)
{
    const auto found = _wanted.find(part.Of);
    if (found == _wanted.end() || found->second.Kind != part.Kind || found->second.From.Tag != from.Tag)
    {
        return;
    }
    Lack &lack = found->second;
    lack.Named = now;
    if (lack.Size != part.Size)
    {
        DropParts(lack);
        lack.Size = part.Size;
    }
    const auto [at, isNew] = lack.Parts.try_emplace(part.Index, part.Bytes.begin(), part.Bytes.end());
    if (!isNew)
    {
        return;
    }
    lack.Progress = now;
    lack.Bytes += part.Bytes.size();
    _incomplete += part.Bytes.size();
    // The other parts may be on their way.
    lack.Retry.Begin(now + Gather);
    if (_incomplete > MostIncomplete)
    {
        DropParts(std::max_element(_wanted.begin(), _wanted.end(),
                                   [](const auto &a, const auto &b)
                                   { return a.second.Bytes < b.second.Bytes; })
                      ->second);
    }
}

std::optional<BlobExchange::Blob> BlobExchange::Complete(const Hash &hash, TimePoint now)
{
    const auto found = _wanted.find(hash);
    if (found == _wanted.end() || found->second.Size == 0 || LackingOf(found->second) != 0)
    {
        return std::nullopt;
    }
    Lack &lack = found->second;
    Blob blob{.Kind = lack.Kind, .Of = hash};
    for (const auto &[index, bytes] : lack.Parts)
    {
        blob.Bytes.insert(blob.Bytes.end(), bytes.begin(), bytes.end());
    }
    if (Sha256(blob.Bytes) != hash)
    {
        // A member lies. Any other source replaces it.
        DropParts(lack);
        lack.Progress = now - SourcePatience - std::chrono::milliseconds(1);
        return std::nullopt;
    }
    Drop(hash);
    return blob;
}

std::uint64_t BlobExchange::LackingOf(const Lack &lack)
{
    std::uint64_t lacking = lack.Size == 0 ? ~std::uint64_t{0} : AllBlobPartsOf(lack.Size);
    for (const auto &[index, bytes] : lack.Parts)
    {
        lacking &= ~(std::uint64_t{1} << index);
    }
    return lacking;
}

void BlobExchange::Take(const BlobRequest &request, const Source &from, bool isProven, TimePoint now)
{
    const auto wanted = _wanted.find(request.Wanted);
    if (wanted != _wanted.end() && !std::exchange(wanted->second.IsSpared, true))
    {
        wanted->second.Retry.Postpone(now + FirstRetry);
    }
    if (request.Of != _self)
    {
        return;
    }
    for (std::size_t kind = 0; kind < BlobKinds; ++kind)
    {
        const OwnBlob &own = _owned[kind];
        if (own.Of != request.Wanted)
        {
            continue;
        }
        for (std::size_t index = 0; index < own.Parts.size(); ++index)
        {
            const std::size_t size =
                BlobPartFront + std::min(BlobPartSize, own.Bytes->size() - index * BlobPartSize);
            const bool isPaid = isProven || _credit >= size;
            if ((request.Parts >> index & 1) != 0 && isPaid)
            {
                _credit -= isProven ? 0 : size;
                WantPart(BlobKind{static_cast<std::uint8_t>(kind)}, index, from.In, now);
            }
        }
    }
}

void BlobExchange::WantPart(BlobKind kind, std::size_t index, Epoch in, TimePoint now)
{
    OwnPart &part = _owned[static_cast<std::size_t>(kind)].Parts[index];
    if (now - part.Asked >= Quiet)
    {
        part.Gap.Reset();
    }
    part.Asked = now;
    if (now - part.SentAt >= Crossing && !std::exchange(part.IsWanted, true))
    {
        part.In = in;
        part.NotBefore = std::max(part.NotBefore, now);
    }
}

}  // namespace Rabit::Envelope
