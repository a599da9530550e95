#include "common/DiscoveryOutbox.h"

#include <utility>

#include "common/RtpsSubmessages.h"

namespace Rabit
{

namespace
{

// OMG DDSI-RTPS 2.3, 9.4.5
constexpr std::uint8_t AckNack = 0x06;
constexpr std::uint8_t Heartbeat = 0x07;
constexpr std::uint8_t InfoSource = 0x0c;
constexpr std::uint8_t InfoDestination = 0x0e;
constexpr std::size_t PrefixAt = 8;      // of a header, and of INFO_SRC
constexpr std::size_t EntitiesSize = 8;  // the reader, and the writer
constexpr std::uint8_t LittleEndian = 0x01;
constexpr std::size_t DestinationSize = SubmessageHeaderSize + std::tuple_size_v<DiscoveryPart::Prefix>;
constexpr DiscoveryPart::Prefix All{};

void AppendDestination(const DiscoveryPart::Prefix &to, std::vector<std::uint8_t> &bytes)
{
    bytes.insert(bytes.end(), {InfoDestination, LittleEndian, static_cast<std::uint8_t>(to.size()), 0});
    bytes.insert(bytes.end(), to.begin(), to.end());
}

}  // namespace

void DiscoveryOutbox::SetRate(double most)
{
    _isSet = most > 0.0;
    _most = _isSet ? std::min(most, MostRate) : MostRate;
    if (_isSet)
    {
        _left = std::min(_left, std::min(Burst, _most));
    }
}

void DiscoveryOutbox::PutHeader(std::span<const std::uint8_t> message)
{
    std::copy_n(message.begin(), std::min(message.size(), _header.size()), _header.begin());
}

void DiscoveryOutbox::Put(std::span<const std::uint8_t> message, DiscoveryPart part, const Route &route,
                          TimePoint now)
{
    PutHeader(message);
    if (part.IsNews && route.Group)
    {
        part = ForAll(std::move(part));
    }
    if (_slots.size() >= _sweepAt)
    {
        ForgetOld(now);
    }
    if (_slots.size() >= MostSlots)
    {
        ForgetRested(now);
    }
    const Key key{
        .ToGroup = route.Group.has_value(), .Way = route.Group.value_or(route.Address), .About = part.About};
    const auto found = _slots.try_emplace(key).first;
    Slot &slot = found->second;
    if (slot.Said && now - slot.AskedAt >= Rest)
    {
        slot.Said = false;
        slot.Gap = Duration(0);
    }
    slot.AskedAt = now;
    slot.Address = route.Address;
    const bool isRepeat = slot.Said && slot.Content == part.Content;
    slot.Part = std::move(part);
    const auto &to = slot.Part.About.To;
    if (slot.Part.IsNews && to != All && !_knowUs.contains(to))
    {
        return;
    }
    SetDue(found, isRepeat ? std::max(now, slot.SaidAt + slot.Gap) : now + Hold);
}

void DiscoveryOutbox::SetDue(Slots::iterator slot, TimePoint due)
{
    auto &current = slot->second.Due;
    if (current && current->first <= due)
    {
        return;
    }
    if (current)
    {
        _due.erase(*current);
    }
    current = {due, ++_turn};
    _due.emplace(*current, slot);
}

// A node that starts again and again is another peer each time.
void DiscoveryOutbox::ForgetOld(TimePoint now)
{
    const auto isOld = [now](TimePoint last) { return now - last >= Forgotten; };
    std::erase_if(_slots, [&](const auto &slot) { return !slot.second.Due && isOld(slot.second.AskedAt); });
    std::erase_if(_questions, [&](const auto &asked) { return isOld(asked.second.Last); });
    std::erase_if(_heard, [&](const auto &peer) { return isOld(peer.second); });
    std::erase_if(_knowUs, [&](const auto &peer) { return !_heard.contains(peer.first); });
    _sweepAt = std::max(FewestToSweep, 2 * _slots.size());
}

void DiscoveryOutbox::ForgetRested(TimePoint now)
{
    std::erase_if(_slots,
                  [now](const auto &slot) { return !slot.second.Due && now - slot.second.AskedAt >= Rest; });
    // So much at once is nothing that a fleet says. The protocol says again what it needs.
    if (_slots.size() > MostSlots / 2)
    {
        _due.clear();
        _slots.clear();
        _questions.clear();
    }
}

void DiscoveryOutbox::Sent(std::size_t size, TimePoint now)
{
    Fill(now);
    // However much that is, this comes to speak.
    _left = std::max(_left - static_cast<double>(size + Headers), std::min(_left, 0.0));
}

void DiscoveryOutbox::Announced(std::span<const std::uint8_t> message, TimePoint now)
{
    PutHeader(message);
    _announcedAt = now;
    if (_isSet || !_roundAt || now - *_roundAt >= Round)
    {
        Sent(message.size(), now);
        _roundAt = now;
    }
}

void DiscoveryOutbox::Fill(TimePoint now)
{
    if (now > _filledAt)
    {
        const double filled = _left + Rate() * std::chrono::duration<double>(now - _filledAt).count();
        _left = std::min(filled, std::max(_left, std::min(Burst, Rate())));
        _filledAt = now;
    }
}

DiscoveryOutbox::TimePoint DiscoveryOutbox::Free() const
{
    return _left > 0.0
               ? TimePoint{}
               : _filledAt +
                     std::chrono::ceil<Duration>(std::chrono::duration<double>((1.0 - _left) / Rate()));
}

std::optional<DiscoveryOutbox::TimePoint> DiscoveryOutbox::Due() const
{
    return _due.empty() ? std::nullopt : std::optional(std::max(_due.begin()->first.first, Free()));
}

std::optional<DiscoveryOutbox::TimePoint> DiscoveryOutbox::HeldUpSince() const
{
    const bool isHeldUp = !_due.empty() && Free() > _due.begin()->first.first && _rate < FirstRate && !_isSet;
    return isHeldUp ? std::optional(_due.begin()->first.first) : std::nullopt;
}

std::vector<DiscoveryOutbox::Datagram> DiscoveryOutbox::TakeDue(TimePoint now)
{
    std::vector<Datagram> taken;
    Fill(now);
    while (!_due.empty() && _due.begin()->first.first <= now && _left > 0.0)
    {
        taken.push_back(Take(now));
        _left -= static_cast<double>(taken.back().Bytes.size() + Headers);
    }
    return taken;
}

std::size_t DiscoveryOutbox::Largest() const
{
    return std::clamp(static_cast<std::size_t>(Rate() / 2.0), SmallestDatagram, LargestDatagram);
}

DiscoveryOutbox::Slots::iterator DiscoveryOutbox::First(TimePoint now) const
{
    const auto first = _due.begin();
    const auto last = _aheadOfNews < Largest() ? _due.upper_bound({now, UINT64_MAX}) : std::next(first);
    const auto control =
        std::find_if(first, last, [](const auto &due) { return !due.second->second.Part.IsNews; });
    return (control != last ? control : first)->second;
}

// The first, and what is due as well and can go with it.
DiscoveryOutbox::Datagram DiscoveryOutbox::Take(TimePoint now)
{
    const auto first = First(now);
    const bool isAhead = first != _due.begin()->second;
    std::vector<Slots::iterator> chosen;
    std::set<DiscoveryPart::Prefix> destinations;
    std::size_t size = _header.size();
    const auto choose = [&](Slots::iterator slot)
    {
        const auto &to = slot->first.About.To;
        const std::size_t more =
            slot->second.Part.Bytes.size() + (to == All || destinations.contains(to) ? 0 : DestinationSize);
        const bool goesAlong =
            slot->first.ToGroup == first->first.ToGroup && slot->first.Way == first->first.Way;
        if (goesAlong && (chosen.empty() || size + more <= Largest()))
        {
            chosen.push_back(slot);
            destinations.insert(to);
            size += more;
        }
    };
    choose(first);
    for (auto at = _due.begin(); at != _due.end() && at->first.first <= now; ++at)
    {
        if (at->second != first)
        {
            choose(at->second);
        }
    }
    const bool isForOne = destinations.size() == 1 && *destinations.begin() != All;
    Datagram datagram{.Address = first->second.Address,
                      .ToGroup = first->first.ToGroup && !isForOne,
                      .Bytes = {_header.begin(), _header.end()}};
    // What is for all first: a destination holds until the next one.
    for (const auto &to : destinations)
    {
        if (to != All)
        {
            AppendDestination(to, datagram.Bytes);
        }
        for (const auto slot : chosen)
        {
            if (slot->first.About.To == to)
            {
                const auto &bytes = slot->second.Part.Bytes;
                datagram.Bytes.insert(datagram.Bytes.end(), bytes.begin(), bytes.end());
            }
        }
    }
    for (const auto slot : chosen)
    {
        Go(slot, now);
    }
    _aheadOfNews = isAhead ? _aheadOfNews + datagram.Bytes.size() : 0;
    return datagram;
}

DiscoveryOutbox::Duration DiscoveryOutbox::FirstGapOf(const Slot &slot) const
{
    return std::min<Duration>(
        std::max<Duration>(slot.Part.IsNews ? FirstGapOfNews : FirstGap, 2 * _answerTime), LongestGap);
}

void DiscoveryOutbox::Go(Slots::iterator slot, TimePoint now)
{
    Slot &said = slot->second;
    _due.erase(*said.Due);
    said.Due.reset();
    const bool isRepeat = said.Said && said.Content == said.Part.Content;
    const Duration first = FirstGapOf(said);
    const int factor = said.Part.IsNews ? 4 : 2;
    said.Gap = std::min<Duration>(isRepeat ? factor * said.Gap : first, LongestGap);
    if (said.Part.About.Kind == Heartbeat && said.Part.About.To != All)
    {
        Ask({said.Part.About.To, said.Part.About.Writer}, !slot->first.ToGroup, isRepeat, now);
    }
    said.Said = true;
    said.Content = said.Part.Content;
    said.SaidAt = now;
}

void DiscoveryOutbox::Ask(const Question &question, bool alone, bool again, TimePoint now)
{
    const auto found = _questions.find(question);
    if (found != _questions.end() && found->second.Answered)
    {
        found->second = {.First = now, .Last = now};
    }
    if (found != _questions.end())
    {
        found->second.Last = now;
        return;
    }
    if (again)
    {
        return;  // it was answered
    }
    if (_questions.size() >= MostSlots)
    {
        std::erase_if(_questions, [now](const auto &asked) { return now - asked.second.Last >= Rest; });
    }
    if (_questions.size() < MostSlots)
    {
        _questions.emplace(
            question,
            Asked{.First = now, .Last = now, .HeardUs = !alone || _knowUs.contains(question.first)});
    }
}

void DiscoveryOutbox::Received(std::span<const std::uint8_t> message, TimePoint now)
{
    DiscoveryPart::Prefix own{};
    std::copy_n(_header.begin() + PrefixAt, own.size(), own.begin());
    DiscoveryPart::Prefix from{};
    DiscoveryPart::Prefix to{};
    const auto put = [](std::span<const std::uint8_t> bytes, std::size_t at, DiscoveryPart::Prefix &prefix)
    {
        if (bytes.size() >= at + prefix.size())
        {
            std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(at), prefix.size(), prefix.begin());
        }
    };
    put(message, PrefixAt, from);
    if (from != own)
    {
        Heard(from, now);
    }
    VisitSubmessages(message,
                     [&](const RtpsSubmessage<const std::uint8_t> &submessage)
                     {
                         const auto body = submessage.Body();
                         if (submessage.Kind == InfoSource)
                         {
                             put(body, PrefixAt, from);
                         }
                         else if (submessage.Kind == InfoDestination)
                         {
                             put(body, 0, to);
                         }
                         else if (to == own && submessage.Kind == Heartbeat)
                         {
                             KnowsUs(from, now);
                         }
                         else if (to == own && submessage.Kind == AckNack && body.size() >= EntitiesSize)
                         {
                             DiscoveryPart::Entity writer{};
                             std::copy_n(body.begin() + writer.size(), writer.size(), writer.begin());
                             KnowsUs(from, now);
                             Answered({from, writer}, now);
                         }
                     });
}

void DiscoveryOutbox::Heard(const DiscoveryPart::Prefix &peer, TimePoint now)
{
    if (_heard.size() >= MostSlots)
    {
        _heard.clear();
    }
    const auto [known, isNew] = _heard.try_emplace(peer, now);
    if (!isNew && now - std::exchange(known->second, now) < Rest)
    {
        return;
    }
    for (auto at = _slots.begin(); at != _slots.end(); ++at)
    {
        Slot &slot = at->second;
        if (slot.Said && at->first.About.To == All)
        {
            slot.Said = false;
            if (slot.Due)
            {
                SetDue(at, now);
            }
        }
    }
}

void DiscoveryOutbox::KnowsUs(const DiscoveryPart::Prefix &peer, TimePoint now)
{
    if (_knowUs.size() >= MostSlots)
    {
        _knowUs.clear();  // those that are there say something again
    }
    const auto [known, isNew] = _knowUs.try_emplace(peer, now);
    if (!isNew && now - std::exchange(known->second, now) < Rest)
    {
        return;
    }
    for (auto at = _slots.begin(); at != _slots.end(); ++at)
    {
        Slot &slot = at->second;
        if (at->first.About.To == peer && slot.Part.IsNews && !slot.Said)
        {
            SetDue(at, now);
        }
        else if (at->first.About.To == peer && slot.Said && isNew)
        {
            slot.Said = false;
            if (slot.Due)
            {
                SetDue(at, now);
            }
        }
    }
}

void DiscoveryOutbox::Answered(const Question &question, TimePoint now)
{
    const auto found = _questions.find(question);
    if (found == _questions.end() || found->second.Answered)
    {
        return;
    }
    Fill(now);
    const Asked asked = found->second;
    const Duration whole = now - asked.First;
    const Duration sinceAsked = asked.HeardUs ? whole : now - asked.Last;
    const Duration sinceHeard =
        asked.HeardUs || !_announcedAt ? sinceAsked : std::min(sinceAsked, now - *_announcedAt);
    const bool isLate = sinceHeard > Late;
    if (asked.HeardUs || sinceAsked <= Quick || isLate)
    {
        _questions.erase(found);
    }
    else
    {
        found->second.Answered = true;
    }
    _answerTime = std::max(isLate ? whole : sinceHeard, _answerTime / 2);
    if (sinceAsked <= Quick)
    {
        RaiseRate(now);
    }
    else if (isLate && asked.First >= _loweredAt)
    {
        LowerRate(now);
    }
}

void DiscoveryOutbox::CameLate(Duration delay, TimePoint now)
{
    Fill(now);
    if (delay <= Quick && now - std::max(_raisedAt, _loweredAt) >= RaiseGap)
    {
        RaiseRate(now);
    }
    else if (delay > Late && now - _loweredAt >= LowerGap)
    {
        LowerRate(now);
    }
}

void DiscoveryOutbox::RaiseRate(TimePoint now)
{
    _rate = std::min(_rate * (_loweredAt == TimePoint{} ? FirstRaise : Raise), MostRate);
    _raisedAt = now;
}

void DiscoveryOutbox::LowerRate(TimePoint now)
{
    _rate = std::max(_rate * Lower, LeastRate);
    _loweredAt = now;
}

}  // namespace Rabit
