// BlobExchange: the messages that are due.
#include <rabit/base/Earliest.h>

#include <algorithm>
#include <utility>

#include "envelope/BlobExchange.h"

namespace Rabit::Envelope
{

std::optional<TimePoint> BlobExchange::Due() const
{
    std::optional<TimePoint> due;
    for (const OwnBlob &own : _owned)
    {
        for (const OwnPart &part : own.Parts)
        {
            due = part.IsWanted ? Earliest<TimePoint>({due, part.NotBefore}) : due;
        }
    }
    for (const auto &[hash, lack] : _wanted)
    {
        due = Earliest<TimePoint>({due, lack.Retry.Due()});
    }
    for (const auto &[in, offered] : _offers)
    {
        due = Earliest<TimePoint>({due, offered.Timer.Due()});
    }
    return due;
}

std::size_t BlobExchange::DueBytes(TimePoint now)
{
    MakeOffers(now);
    if (const DuePart part = NextPart(now); part.Of != nullptr)
    {
        return BlobPartFront + part.Content.Bytes.size();
    }
    const auto in = RequestsIn(now);
    if (!in)
    {
        return 0;
    }
    const auto requests =
        std::count_if(_wanted.begin(), _wanted.end(),
                      [&in, now](const auto &each) { return IsRequested(each.second, *in, now); });
    return BlobFront + BlobRequestSize * std::min(static_cast<std::size_t>(requests), MostBlobRequests);
}

std::optional<BlobExchange::Outgoing> BlobExchange::TakeDue(TimePoint now)
{
    MakeOffers(now);
    auto taken = TakePart(now);
    return taken ? std::move(taken) : TakeRequests(now);
}

// An offer is the first part, as if somebody had asked for it. It ends once nobody sends in that epoch.
void BlobExchange::MakeOffers(TimePoint now)
{
    const bool hasBulletin = !_owned[static_cast<std::size_t>(BlobKind::Bulletin)].Parts.empty();
    for (auto each = _offers.begin(); each != _offers.end();)
    {
        Offered &offered = each->second;
        if (!offered.Timer.IsDue(now))
        {
            ++each;
            continue;
        }
        if (!hasBulletin || now - offered.Heard > LongestOffer)
        {
            each = _offers.erase(each);
            continue;
        }
        WantPart(BlobKind::Bulletin, 0, each->first, now);
        offered.Timer.Done(now);
        offered.Latest = *offered.Timer.Due() + LongestPostponed;
        ++each;
    }
}

// The part that has been due for longest.
BlobExchange::DuePart BlobExchange::NextPart(TimePoint now)
{
    DuePart next;
    for (std::size_t kind = 0; kind < BlobKinds; ++kind)
    {
        OwnBlob &own = _owned[kind];
        for (std::size_t index = 0; index < own.Parts.size(); ++index)
        {
            OwnPart &part = own.Parts[index];
            if (part.IsWanted && part.NotBefore <= now &&
                (next.Of == nullptr || part.NotBefore < next.Of->NotBefore))
            {
                next.Of = &part;
                BlobPart &content = next.Content;
                content = {.Kind = BlobKind{static_cast<std::uint8_t>(kind)},
                           .Index = index,
                           .Size = own.Bytes->size(),
                           .Of = own.Of,
                           .Bytes = std::span(*own.Bytes).subspan(index * BlobPartSize)};
                content.Bytes = content.Bytes.first(std::min(BlobPartSize, content.Bytes.size()));
            }
        }
    }
    return next;
}

std::optional<BlobExchange::Outgoing> BlobExchange::TakePart(TimePoint now)
{
    const DuePart next = NextPart(now);
    if (next.Of == nullptr)
    {
        return std::nullopt;
    }
    next.Of->IsWanted = false;
    next.Of->SentAt = now;
    next.Of->NotBefore = now + next.Of->Gap.Next();
    return Outgoing{.In = next.Of->In, .Message = WriteBlobMessage(_own, {.Part = next.Content})};
}

// The epoch in which a request is due. Drops blobs that nobody names any more.
std::optional<Epoch> BlobExchange::RequestsIn(TimePoint now)
{
    std::optional<Epoch> in;
    for (auto each = _wanted.begin(); each != _wanted.end();)
    {
        const bool isDue = each->second.Retry.IsDue(now);
        if (isDue && now - each->second.Named > Forgotten)
        {
            DropParts(each->second);
            each = _wanted.erase(each);
            continue;
        }
        in = isDue && !in ? each->second.From.In : in;
        ++each;
    }
    return in;
}

// True if a request that is due is asked for in that epoch, or one that will be due soon.
bool BlobExchange::IsRequested(const Lack &lack, Epoch in, TimePoint now)
{
    return lack.From.In == in && lack.Retry.IsDue(now + Together);
}

// Asks, in one epoch, for all that is due there, or will be due soon and was asked for before.
std::optional<BlobExchange::Outgoing> BlobExchange::TakeRequests(TimePoint now)
{
    const auto in = RequestsIn(now);
    if (!in)
    {
        return std::nullopt;
    }
    BlobMessage message;
    const auto answers = AnswerTakes * static_cast<int>(std::min(_wanted.size(), MostAnswers));
    for (auto &[hash, lack] : _wanted)
    {
        if (IsRequested(lack, *in, now) && message.Requests.size() < MostBlobRequests)
        {
            message.Requests.push_back({.Of = lack.From.Tag, .Wanted = hash, .Parts = LackingOf(lack)});
            lack.IsSpared = false;
            lack.Retry.Done(now, answers);
        }
    }
    return Outgoing{.In = *in, .Message = WriteBlobMessage(_own, message)};
}

}  // namespace Rabit::Envelope
