#include "rtps/CardExchange.h"

#include <rabit/base/Assert.h>
#include <rabit/base/Earliest.h>

#include <algorithm>
#include <utility>

#include "rtps/PackedCard.h"

namespace Rabit::Rtps
{

void CardExchange::SetOwn(std::vector<std::uint8_t> packed, TimePoint now)
{
    _packed = std::move(packed);
    _own = SummaryOf(_packed);
    _parts.assign(_own.Parts(), OwnPart{});
    Want(_own.AllParts(), std::nullopt, {}, now, now);
    _summary.Begin(now + FirstSummary);
    _nextPeriod = now + _settings.Period;
}

CardExchange::Peer *CardExchange::Find(const GuidPrefix &peer, TimePoint now)
{
    if (peer == _self)
    {
        return nullptr;
    }
    const auto found = _peers.find(peer);
    if (found == _peers.end() && _peers.size() >= MostPeers && !MakeRoom())
    {
        return nullptr;
    }
    Peer &known = found == _peers.end() ? _peers[peer] : found->second;
    known.Heard = now;
    return &known;
}

// Forgets the peer without a card that was silent for longest: a forger can invent participants.
bool CardExchange::MakeRoom()
{
    auto oldest = _peers.end();
    for (auto at = _peers.begin(); at != _peers.end(); ++at)
    {
        if (at->second.Held.Size == 0 && (oldest == _peers.end() || at->second.Heard < oldest->second.Heard))
        {
            oldest = at;
        }
    }
    if (oldest == _peers.end())
    {
        return false;
    }
    DropParts(oldest->second);
    _peers.erase(oldest);
    return true;
}

void CardExchange::Forget(const GuidPrefix &peer)
{
    const auto found = _peers.find(peer);
    if (found != _peers.end())
    {
        DropParts(found->second);
        _peers.erase(found);
    }
}

bool CardExchange::IsNews(const Peer &peer, const CardMessage &message, TimePoint now)
{
    const bool isOther = message.Summary.Size > 0 && message.Summary != peer.Wanted;
    const bool isLater = static_cast<std::int32_t>(message.SentAt - peer.WantedAt) >= 0;
    const bool isLacking = peer.Wanted != peer.Held && now - peer.WantedSince >= Believed;
    return isOther && (peer.Wanted.Size == 0 || isLater || isLacking);
}

void CardExchange::DropParts(Peer &peer)
{
    _incomplete -= std::exchange(peer.PartBytes, 0);
    peer.Parts.clear();
}

void CardExchange::KeepPart(Peer &peer, const CardMessage &message)
{
    std::vector<std::uint8_t> &part = peer.Parts[message.Part];
    const std::size_t more = message.Bytes.size() - std::min(part.size(), message.Bytes.size());
    part.assign(message.Bytes.begin(), message.Bytes.end());
    peer.PartBytes += more;
    _incomplete += more;
    if (_incomplete > MostIncomplete)
    {
        DropParts(std::max_element(_peers.begin(), _peers.end(),
                                   [](const auto &a, const auto &b)
                                   { return a.second.PartBytes < b.second.PartBytes; })
                      ->second);
    }
}

// A peer that was heard is in reach: its request starts again with the shortest interval, unless the channel
// is full.
void CardExchange::Ask(Peer &peer, TimePoint due, TimePoint now)
{
    if (peer.Request.Due() && (IsCrowd() || Delay(now) > FirstRetry))
    {
        peer.Request.Hasten(due);
    }
    else if (!peer.Request.Due() || *peer.Request.Due() > due)
    {
        peer.Request.Begin(due);
        peer.Asked = 0;
    }
}

void CardExchange::Heard(const GuidPrefix &peer, TimePoint now)
{
    const auto found = _peers.find(peer);
    if (found != _peers.end() && (found->second.Request.Due() || LackingOf(found->second) == 0))
    {
        found->second.Heard = now;
        return;
    }
    const bool hasCard = found != _peers.end() && found->second.HasCard;
    if ((found != _peers.end() && Rests(found->second, now)) || (!hasCard && !MayAskUnknown(now)))
    {
        return;
    }
    if (Peer *const known = Find(peer, now))
    {
        known->IsAnnounced = false;
        Ask(*known, now, now);
    }
}

bool CardExchange::Rests(const Peer &peer, TimePoint now) const
{
    return peer.Asked >= (peer.HasCard ? MostRequests : MostVainRequests) &&
           now - peer.LastAsked < (peer.IsAnnounced ? ShortRest : Rest);
}

bool CardExchange::MayAskUnknown(TimePoint now)
{
    while (!_unknown.empty() && now - _unknown.front() >= Rest)
    {
        _unknown.pop_front();
    }
    const bool may = _unknown.size() < MostUnknown;
    if (may)
    {
        _unknown.push_back(now);
    }
    return may;
}

void CardExchange::Announced(const GuidPrefix &peer, TimePoint now)
{
    Peer *const known = Find(peer, now);
    if (known == nullptr)
    {
        return;
    }
    known->IsAnnounced = true;
    if (LackingOf(*known) != 0 && !known->Request.Due())
    {
        Ask(*known, now + Patience, now);
    }
}

std::uint64_t CardExchange::LackingOf(const Peer &peer)
{
    if (peer.Wanted.Size == 0)
    {
        return peer.Held.Size == 0 ? ~std::uint64_t{0} : 0;
    }
    std::uint64_t lacking = peer.Wanted == peer.Held ? 0 : peer.Wanted.AllParts();
    for (const auto &[number, bytes] : peer.Parts)
    {
        lacking &= ~(std::uint64_t{1} << number);
    }
    return lacking;
}

std::optional<CardExchange::Card> CardExchange::Received(const CardMessage &message, TimePoint now)
{
    Peer *const peer = Find(message.From, now);
    if (peer == nullptr)
    {
        return std::nullopt;
    }
    peer->HasCard = true;
    peer->Late.Heard(message.SentAt, now);
    if (message.HasPart && message.Answers.From == _self)
    {
        Answered(*peer, message.Answers.SentAt, now);
    }
    for (const CardRequest &request : message.Requests)
    {
        Take(request, message, now);
    }
    if (IsNews(*peer, message, now))
    {
        peer->Wanted = message.Summary;
        peer->WantedSince = now;
        peer->WantedAt = message.SentAt;
        DropParts(*peer);
        peer->Request.Stop();
    }
    if (message.Summary == peer->Wanted && static_cast<std::int32_t>(message.SentAt - peer->WantedAt) > 0)
    {
        peer->WantedAt = message.SentAt;
    }
    if (message.HasPart && message.Summary == peer->Wanted && peer->Wanted != peer->Held)
    {
        KeepPart(*peer, message);
        peer->Asked = 0;
    }
    if (LackingOf(*peer) != 0)
    {
        // The peer is in reach, so it is asked at once, unless an answer may be on its way.
        const TimePoint soon = now + (message.Summary.Size > 0 ? Patience : std::chrono::milliseconds(0));
        Ask(*peer, std::max(soon, peer->LastAsked + DelaysOfAnAnswer * Delay(now)), now);
        return std::nullopt;
    }
    peer->Request.Stop();
    peer->LacksSince.reset();
    if (peer->Wanted == peer->Held)
    {
        return std::nullopt;
    }
    Card card{.Of = message.From, .Packed = {}};
    for (const auto &[number, bytes] : peer->Parts)
    {
        card.Packed.insert(card.Packed.end(), bytes.begin(), bytes.end());
    }
    DropParts(*peer);
    if (SummaryOf(card.Packed) != peer->Wanted)
    {
        Refuse(message.From, now);
        return std::nullopt;
    }
    if (peer->Held.Size == 0 && !_greeting.Due())
    {
        _greeting.Begin(now + FirstSummary);
    }
    peer->Held = peer->Wanted;
    return card;
}

// Pending requests are repeated no sooner than the round trip allows. An answer to a request that was never
// sent, or not that early, is a lie.
void CardExchange::Answered(Peer &peer, std::uint32_t sentAt, TimePoint now)
{
    if (!peer.LacksSince || static_cast<std::int32_t>(sentAt - QueueingDelay::Stamp(*peer.LacksSince)) < 0)
    {
        return;
    }
    peer.Late.Answered(sentAt, now);
    const Duration answer = DelaysOfAnAnswer * Delay(now);
    for (auto &[name, other] : _peers)
    {
        if (other.Asked > 0)
        {
            other.Request.Postpone(other.LastAsked + answer);
        }
    }
}

// The destination of a message for that node.
std::optional<GuidPrefix> CardExchange::Only(const GuidPrefix &peer) const
{
    return _settings.IsMulticast ? std::nullopt : std::optional(peer);
}

void CardExchange::Refuse(const GuidPrefix &peer, TimePoint now)
{
    const auto found = _peers.find(peer);
    if (found != _peers.end())
    {
        found->second.Held = {};
        DropParts(found->second);
        Ask(found->second, now + FirstRetry, now);
    }
}

void CardExchange::Take(const CardRequest &request, const CardMessage &message, TimePoint now)
{
    const bool isForSeveral = message.Requests.size() > 1;  // they went to all, and so do the answers
    const auto found = _peers.find(request.Of);
    if (request.Of == _self)
    {
        Want(request.Parts & _own.AllParts(), isForSeveral ? std::nullopt : std::optional(message.From),
             {.From = message.From, .SentAt = message.SentAt - QueueingDelay::Stamp(now)},
             now - _peers[message.From].Late.OfLast(), now);
    }
    else if (isForSeveral && found != _peers.end() && found->second.Request.Due() &&
             !found->second.IsSpared && (LackingOf(found->second) & ~request.Parts) == 0)
    {
        found->second.IsSpared = true;  // the answer serves this node, too
        found->second.Request.Postpone(now + std::max<Duration>(DelaysOfAnAnswer * Delay(now), FirstRetry));
    }
}

// `askedAt`: when the request was sent, by this node's clock. If the part cannot have arrived by then,
// request and part have crossed.
void CardExchange::Want(std::uint64_t parts, const std::optional<GuidPrefix> &by,
                        const AnsweredRequest &request, TimePoint askedAt, TimePoint now)
{
    const Duration delay = Delay(now);
    for (std::size_t number = 0; number < _parts.size(); ++number)
    {
        OwnPart &part = _parts[number];
        const bool wentToIt = part.SentAt && (!part.SentTo || *part.SentTo == request.From);
        if ((parts >> number & 1) == 0 || (wentToIt && askedAt < *part.SentAt + delay))
        {
            continue;
        }
        if (now - part.Asked >= Quiet)
        {
            part.Gap.Reset();
        }
        part.Asked = now;
        part.By = part.IsWanted && part.By != by ? std::nullopt : by;
        if (!std::exchange(part.IsWanted, true))
        {
            part.Answers = request;
            part.NotBefore = std::max(part.NotBefore, now);
        }
    }
}

std::optional<CardExchange::TimePoint> CardExchange::RequestDue() const
{
    std::optional<TimePoint> due;
    for (const auto &[name, peer] : _peers)
    {
        due = Earliest({due, peer.Request.Due()});
    }
    return due;
}

std::optional<CardExchange::TimePoint> CardExchange::PartDue() const
{
    std::optional<TimePoint> due;
    for (const OwnPart &part : _parts)
    {
        due = part.IsWanted ? Earliest<TimePoint>({due, part.NotBefore}) : due;
    }
    return due;
}

std::optional<CardExchange::TimePoint> CardExchange::NextDue() const
{
    return Earliest({RequestDue(), PartDue(), _summary.Due(), _greeting.Due(), _nextPeriod});
}

void CardExchange::Fill(TimePoint now)
{
    if (now > _filledAt)
    {
        const double filled = _left + Rate * std::chrono::duration<double>(now - _filledAt).count();
        _left = std::min(filled, Burst);
        _filledAt = now;
    }
}

CardExchange::TimePoint CardExchange::Free() const
{
    return _left > 0.0
               ? TimePoint{}
               : _filledAt + std::chrono::ceil<Duration>(std::chrono::duration<double>((1.0 - _left) / Rate));
}

std::optional<CardExchange::TimePoint> CardExchange::Due() const
{
    const auto due = NextDue();
    return due && _self != GuidPrefix{} ? std::optional(std::max(*due, Free())) : std::nullopt;
}

// The lower of two medians, since one node may lie. Measurements from answers alone count if there are any:
// the others may share the same delay.
CardExchange::Duration CardExchange::Delay(TimePoint now) const
{
    std::vector<Duration> delays;
    bool areByAnswers = false;
    for (const auto &[name, peer] : _peers)
    {
        const auto delay = peer.Late.At(now);
        const bool isByAnswer = delay && peer.Late.IsByAnswer(now);
        if (isByAnswer && !std::exchange(areByAnswers, true))
        {
            delays.clear();
        }
        if (delay && isByAnswer == areByAnswers)
        {
            delays.push_back(*delay);
        }
    }
    if (delays.empty())
    {
        return Duration(0);
    }
    const auto middle = delays.begin() + static_cast<std::ptrdiff_t>((delays.size() - 1) / 2);
    std::nth_element(delays.begin(), middle, delays.end());
    return *middle;
}

bool CardExchange::IsCrowd() const
{
    const auto asked =
        std::count_if(_peers.begin(), _peers.end(),
                      [](const auto &peer) { return peer.second.Request.Due() && peer.second.Asked > 0; });
    return static_cast<std::size_t>(asked) >= Several;
}

std::optional<CardExchange::Outgoing> CardExchange::TakeDue(TimePoint now)
{
    Fill(now);
    if (_left <= 0.0 || _self == GuidPrefix{})
    {
        return std::nullopt;
    }
    std::optional<Outgoing> taken;
    const bool isSummaryDue = IsSummaryDue(now);
    if (IsPartNext(now))
    {
        taken = TakePart(now);
    }
    else if (IsBy(RequestDue(), now))
    {
        taken = TakeRequests(now);
    }
    else if (isSummaryDue)
    {
        taken = Outgoing{
            .To = std::nullopt,
            .Bytes = WriteCardMessage({.From = _self, .Summary = _own, .SentAt = QueueingDelay::Stamp(now)})};
    }
    if (taken)
    {
        if (isSummaryDue && !taken->To)  // each message has the summary
        {
            SentSummary(now);
        }
        _left -= static_cast<double>(taken->Bytes.size() + IpAndUdp);
    }
    return taken;
}

// True if a part is due, and has been for longer than any request. Where the holder allows little, there is
// always a request that is due, and parts would never go.
bool CardExchange::IsPartNext(TimePoint now) const
{
    const auto part = PartDue();
    return IsBy(part, now) && *part <= RequestDue().value_or(now);
}

std::size_t CardExchange::DueBytes(TimePoint now) const
{
    if (!IsBy(Due(), now))
    {
        return 0;
    }
    const bool isPart = IsPartNext(now);
    const auto requests = std::count_if(_peers.begin(), _peers.end(),
                                        [now](const auto &peer) { return peer.second.Request.IsDue(now); });
    return IpAndUdp +
           CardMessageSize(isPart ? 0 : std::min(static_cast<std::size_t>(requests), MostCardRequests),
                           isPart ? std::min(CardPartSize, _packed.size()) : 0);
}

bool CardExchange::IsSummaryDue(TimePoint now) const
{
    return IsBy(Earliest({_summary.Due(), _greeting.Due(), _nextPeriod}), now);
}

void CardExchange::SentSummary(TimePoint now)
{
    for (BackoffTimer<TimePoint> *const series : {&_summary, &_greeting})
    {
        if (series->IsDue(now))
        {
            series->Done(now, Delay(now));
        }
    }
    _nextPeriod = now + _settings.Period;
}

// Peers whose requests have been due for longest. Empty if none is due; those due soon are included.
std::vector<std::pair<GuidPrefix, CardExchange::Peer *>> CardExchange::ToBeAsked(TimePoint now)
{
    std::vector<std::pair<GuidPrefix, Peer *>> peers;
    bool isAnyDue = false;
    for (auto &[name, peer] : _peers)
    {
        isAnyDue |= peer.Request.IsDue(now);
        if (peer.Request.IsDue(now + (peer.Asked > 0 ? Duration(Together) : Duration(0))))
        {
            peers.emplace_back(name, &peer);
        }
    }
    const auto most = std::min(isAnyDue ? peers.size() : 0, MostCardRequests);
    std::partial_sort(peers.begin(), peers.begin() + static_cast<std::ptrdiff_t>(most), peers.end(),
                      [](const auto &a, const auto &b)
                      { return *a.second->Request.Due() < *b.second->Request.Due(); });
    peers.resize(most);
    return peers;
}

CardExchange::Outgoing CardExchange::TakeRequests(TimePoint now)
{
    CardMessage message{.From = _self, .Summary = _own, .SentAt = QueueingDelay::Stamp(now)};
    const Duration answered = DelaysOfAnAnswer * Delay(now);
    const bool isCrowd = IsCrowd();
    for (const auto &[name, asked] : ToBeAsked(now))
    {
        Peer &peer = *asked;
        message.Requests.push_back({.Of = name, .Parts = LackingOf(peer)});
        peer.IsSpared = false;
        peer.FirstAsked = peer.Asked == 0 ? now : peer.FirstAsked;
        peer.LastAsked = now;
        peer.LacksSince = peer.LacksSince.value_or(now);
        const Duration crowd =
            isCrowd ? std::min<Duration>(now - peer.FirstAsked, LongestRetry) : Duration(0);
        peer.Request.Done(now, std::max(answered, crowd));
        if (++peer.Asked >= (peer.HasCard ? MostRequests : MostVainRequests))
        {
            peer.Request.Stop();
        }
    }
    const bool isForOne = message.Requests.size() == 1;
    return {.To = isForOne ? Only(message.Requests.front().Of) : std::nullopt,
            .Bytes = WriteCardMessage(message)};
}

// Takes the part that has been due for longest.
CardExchange::Outgoing CardExchange::TakePart(TimePoint now)
{
    const auto longest =
        std::min_element(_parts.begin(), _parts.end(),
                         [](const OwnPart &a, const OwnPart &b)
                         { return a.IsWanted != b.IsWanted ? a.IsWanted : a.NotBefore < b.NotBefore; });
    RABIT_ASSERT(longest != _parts.end() && longest->IsWanted);
    const auto number = static_cast<std::size_t>(longest - _parts.begin());
    OwnPart &part = *longest;
    CardMessage message{.From = _self,
                        .Summary = _own,
                        .SentAt = QueueingDelay::Stamp(now),
                        .HasPart = true,
                        .Part = number,
                        .Answers = part.Answers};
    message.Answers.SentAt += message.SentAt;
    message.Bytes = std::span(_packed).subspan(
        number * CardPartSize, std::min(CardPartSize, _packed.size() - number * CardPartSize));
    part.IsWanted = false;
    part.SentAt = now;
    part.SentTo = part.By ? Only(*part.By) : std::nullopt;
    part.Answers = {};
    part.NotBefore = now + part.Gap.Next(part.By ? GapFactor : CrowdFactor);
    return {.To = part.SentTo, .Bytes = WriteCardMessage(message)};
}

}  // namespace Rabit::Rtps
