#include "presence/BeatContents.h"

#include <rabit/base/Earliest.h>

#include <algorithm>
#include <span>

#include "presence/Whereabouts.h"
#include "wire/Announcements.h"
#include "wire/BeatExtensions.h"
#include "wire/BeatFormat.h"
#include "wire/BeatNews.h"

namespace Rabit
{
namespace
{

// A smaller part of an announcement is mostly headers, unless it is the last one.
constexpr std::size_t SmallestPart = 64;

// How many entries of a size fit; takes their room.
std::size_t Fit(std::size_t most, std::size_t size, std::size_t &room)
{
    const std::size_t count = std::min(most, room / size);
    room -= count * size;
    return count;
}

std::size_t SizeOf(const AgreementNews &agreement)
{
    return BeatFormat::Agreement(agreement.Renewal.size(), agreement.Answers.size());
}

std::size_t SizeOfStrains(std::size_t count)
{
    return count == 0 ? 0 : BeatFormat::Wanted(count * BeatExtensions::StrainBytes);
}

}  // namespace

void BeatContents::Begin(std::vector<std::uint8_t> offers, std::size_t states)
{
    _offers = std::move(offers);
    _digest = Announcements::DigestOf(_offers);
    _states.assign(states, 0);
    _answer.Begin(_offers.size());
}

std::optional<BeatContents::Duration> BeatContents::QuestionDue() const
{
    // Usually there is none, and each unit of work asks.
    if (_peers.Missing().IsEmpty() && _questions.IsEmpty() && _types.IsEmpty())
    {
        return std::nullopt;
    }
    return Earliest({_peers.Missing().NextDue(), _questions.DueSince(), _types.NextDue()});
}

std::size_t BeatContents::SizeOfPart(Duration now, std::size_t room) const
{
    if (!_answer.Due() || *_answer.Due() > now || room <= BeatFormat::PartHeader)
    {
        return 0;
    }
    const std::size_t size = std::min(_answer.Left(), room - BeatFormat::PartHeader);
    return size < std::min(SmallestPart, _answer.Left()) ? 0 : size;
}

bool BeatContents::IsPlaceDue(Duration now) const
{
    return _peers.OwnNameTwice() && (!_placeSaid || now - *_placeSaid >= PlacePeriod);
}

void BeatContents::LookAtFleet()
{
    const std::uint32_t sum = _peers.FleetSum();
    const bool isNews = HasToolCome() || (_peers.Tools() > 0 && sum != _fleetSum);
    _fleetSumBeats = isNews && !_isTool ? FleetSumBeats : _fleetSumBeats;
    _toolsCome = _peers.ToolsCome();
    _fleetSum = sum;
}

std::size_t BeatContents::SizeOfMarks() const
{
    return (_isTool ? BeatFormat::ToolMark : 0) + (_isReplay ? BeatFormat::ReplayMark : 0) +
           BeatFormat::FirstHeard(std::min(_firstHeard.size(), BeatExtensions::MostFirstHeard));
}

std::optional<AgreementNews> BeatContents::TakeAgreement(std::size_t &room)
{
    if (!HasAgreement() || room < SizeOf(AgreementNews()))
    {
        return std::nullopt;
    }
    AgreementNews agreement = _agreement.Take(room);
    room -= std::min(room, SizeOf(agreement));
    return agreement;
}

std::size_t BeatContents::SizeOfFleetSum() const
{
    return _fleetSumBeats > 0 ? BeatFormat::FleetSum : 0;
}

// Room for the worst strain, if there is one.
std::size_t BeatContents::SizeOfWorstStrain() const
{
    return SizeOfStrains(std::min<std::size_t>(_strains.size(), 1));
}

// Number of strains that a beat with this room reports.
std::size_t BeatContents::StrainsWithin(std::size_t room) const
{
    constexpr std::size_t header = BeatFormat::Wanted(0);
    const std::size_t fit = room > header ? (room - header) / BeatExtensions::StrainBytes : 0;
    return std::min({_strains.size(), BeatExtensions::MostStrains, fit});
}

// Room for the smallest part of the announcement that is worth its header, if one is due.
std::size_t BeatContents::SizeOfLeastPart(Duration now) const
{
    if (!_answer.Due() || *_answer.Due() > now || _answer.Left() == 0)
    {
        return 0;
    }
    return BeatFormat::PartHeader + (std::min(SmallestPart, _answer.Left()) + 3) / 4 * 4;
}

std::size_t BeatContents::LeastSize(Duration now) const
{
    const std::size_t part = SizeOfLeastPart(now);
    const std::size_t marks = SizeOfMarks() + SizeOfAgreement();
    return part == 0 ? (HasAgreement() ? BeatFormat::WithNews + marks : BeatFormat::Empty)
                     : BeatFormat::WithNews + marks + SizeOfProblems(now) + SizeOfFleetSum() +
                           SizeOfWorstStrain() + part;
}

void BeatContents::SetProblems(const ProblemCount &problems)
{
    _problemBeats = problems == _problems ? _problemBeats : ProblemBeats;
    _problems = problems;
}

std::size_t BeatContents::SizeOfProblems(Duration now) const
{
    const bool isDue = _problemBeats > 0 || (_problems.Count > 0 && now - _problemsSaid >= ProblemPeriod);
    return isDue ? BeatFormat::Problems : 0;
}

std::size_t BeatContents::Size(Duration now) const
{
    const std::size_t wants =
        std::min(BeatFormat::MostWants,
                 _peers.Missing().Due(now, BeatFormat::MostWants) + _questions.Count(BeatFormat::MostWants));
    const std::size_t news = SizeOfMarks() + SizeOfAgreement() + SizeOfFleetSum() +
                             SizeOfStrains(StrainsWithin(BeatFormat::Largest)) + SizeOfProblems(now) +
                             wants * BeatFormat::Wanted(_questions.Longest()) +
                             _types.Due(now, BeatFormat::MostTypeQuestions) * BeatFormat::TypeQuestion +
                             _peers.EchoesDue(now, BeatFormat::MostEchoes) * BeatFormat::Echo +
                             _delays.Due(now, BeatFormat::MostDelays) * BeatFormat::Delay +
                             std::min(_states.size(), BeatFormat::MostStates) * BeatFormat::State;
    const std::size_t announced = SizeOfPart(now, BeatFormat::Largest);
    const std::size_t part = announced == 0 && IsPlaceDue(now) ? Whereabouts::Size : announced;
    const std::size_t all = news + (part > 0 ? BeatFormat::PartHeader + (part + 3) / 4 * 4 : 0);
    return all == 0 ? BeatFormat::Empty : std::min(BeatFormat::WithNews + all, BeatFormat::Largest);
}

void BeatContents::Fill(Gateway::Beat &beat, Duration now, std::size_t most)
{
    std::size_t room = std::min(most, BeatFormat::Largest);
    room -= std::min(room, BeatFormat::WithNews + SizeOfMarks());
    const std::optional<AgreementNews> agreement = TakeAgreement(room);
    // Reserved, since only a few beats tell of problems and of the fleet.
    const std::size_t problems = SizeOfProblems(now) <= room ? SizeOfProblems(now) : 0;
    room -= problems;
    const std::size_t fleetSum = SizeOfFleetSum() <= room ? SizeOfFleetSum() : 0;
    room -= fleetSum;
    // Receivers take a beat without strains as their end, so at least the worst one is told. An announcement
    // that never fits would leave this node without commands, so a small part goes before questions.
    const std::size_t leastPart = SizeOfLeastPart(now);
    const std::size_t worst = SizeOfWorstStrain();
    const std::size_t part = worst + leastPart <= room ? leastPart : 0;
    // A receiver that is not in a list with room for more takes its datagrams for punctual, so reports go
    // before all strains but the worst, and before questions.
    const std::size_t roomForDelays = room - part - std::min(room - part, worst);
    const std::size_t delays = BeatFormat::Delay * std::min(_delays.Due(now, BeatFormat::MostDelays),
                                                            roomForDelays / BeatFormat::Delay);
    const std::size_t strains = StrainsWithin(room - part - delays);
    room -= part + delays + SizeOfStrains(strains);
    AddWants(beat, now, room);
    AddTypes(beat, now, room);
    if (problems > 0)
    {
        BeatExtensions::Say(beat, _problems);
        _problemBeats = std::max(_problemBeats - 1, 0);
        _problemsSaid = now;
    }
    if (strains > 0)
    {
        BeatExtensions::Say(beat, std::span<const LinkStrain>(_strains).first(strains));
    }
    Gateway::BeatNews &news = NewsOf(beat);
    news.echoes = _peers.NextEchoes(now, BeatFormat::MostEchoes, room / BeatFormat::Echo);
    room -= news.echoes.size() * BeatFormat::Echo;
    room += delays;
    news.delays = _delays.Take(now, std::min(BeatFormat::MostDelays, room / BeatFormat::Delay));
    room -= news.delays.size() * BeatFormat::Delay;
    room += part;
    AddPart(beat, now, room);
    AddStates(beat, room);
    if (_isTool)
    {
        BeatExtensions::MarkTool(beat);
    }
    if (_isReplay)
    {
        BeatExtensions::MarkReplay(beat);
    }
    if (agreement)
    {
        BeatExtensions::Say(beat, *agreement);
    }
    if (!_firstHeard.empty())
    {
        _nextFirstHeard = BeatExtensions::SayFirstHeard(beat, _firstHeard, _nextFirstHeard);
    }
    if (fleetSum > 0)
    {
        BeatExtensions::SayFleetSum(beat, _fleetSum);
        --_fleetSumBeats;
    }
    DropEmptyNews(beat);
}

void BeatContents::AddWants(Gateway::Beat &beat, Duration now, std::size_t &room)
{
    auto &wants = NewsOf(beat).wants;
    const std::size_t longest = BeatFormat::Wanted(_questions.Longest());
    const std::size_t count = Fit(BeatFormat::MostWants, longest, room);
    for (const MissingOffers::Question &question : _peers.Missing().Take(now, count, _delays.Delay(now)))
    {
        Gateway::Wanted &wanted = wants.emplace_back();
        wanted.node = _peers.Find(question.Node)->Tag;
        wanted.offers = question.From;
    }
    for (StateQuestions::Question &question : _questions.Take(count - wants.size()))
    {
        const PeerTable::Peer *peer = _peers.Find(question.Node);
        if (peer == nullptr || peer->State == Gateway::NodeState::LOST)
        {
            continue;
        }
        auto wanted = std::find_if(wants.begin(), wants.end(),
                                   [peer](const auto &other) { return other.node == peer->Tag; });
        if (wanted == wants.end())
        {
            wanted = wants.insert(wants.end(), Gateway::Wanted());
            wanted->node = peer->Tag;
            wanted->offers = BeatFormat::NotLacking;
        }
        wanted->states = std::move(question.States);
    }
    room += (count - wants.size()) * longest;
}

void BeatContents::AddTypes(Gateway::Beat &beat, Duration now, std::size_t &room)
{
    const std::size_t count = std::min(BeatFormat::MostTypeQuestions, room / BeatFormat::TypeQuestion);
    for (const TypeQuestions::Question &question : _types.Take(now, count))
    {
        const PeerTable::Peer *peer = _peers.Find(question.Node);
        if (peer != nullptr && peer->State != Gateway::NodeState::LOST)
        {
            BeatExtensions::Ask(
                beat, {.Node = peer->Tag, .Definition = question.Definition, .From = question.From});
            room -= BeatFormat::TypeQuestion;
        }
    }
}

void BeatContents::AddPart(Gateway::Beat &beat, Duration now, std::size_t &room)
{
    const std::size_t size = SizeOfPart(now, room / 4 * 4);
    if (size == 0)
    {
        if (IsPlaceDue(now) && room >= BeatFormat::PartHeader + Whereabouts::Size)
        {
            NewsOf(beat).parts.push_back(Whereabouts::Part());
            room -= BeatFormat::PartHeader + Whereabouts::Size;
            _placeSaid = now;
        }
        return;
    }
    const auto first = _offers.begin() + static_cast<std::ptrdiff_t>(_answer.From());
    Gateway::AnnouncementPart &part = NewsOf(beat).parts.emplace_back();
    part.first = static_cast<std::uint16_t>(_answer.From());
    part.of = static_cast<std::uint16_t>(_offers.size());
    part.bytes.assign(first, first + static_cast<std::ptrdiff_t>(size));
    room -= BeatFormat::PartHeader + (size + 3) / 4 * 4;
    _answer.Said(size, now, _delays.Delay(now));
}

void BeatContents::AddStates(Gateway::Beat &beat, std::size_t &room)
{
    if (_nextState >= _states.size())
    {
        _nextState = 0;
    }
    const std::size_t count =
        Fit(std::min(BeatFormat::MostStates, _states.size() - _nextState), BeatFormat::State, room);
    if (count == 0)
    {
        return;
    }
    const auto first = _states.begin() + static_cast<std::ptrdiff_t>(_nextState);
    Gateway::BeatNews &news = NewsOf(beat);
    news.first_state = static_cast<std::uint16_t>(_nextState);
    news.states.assign(first, first + static_cast<std::ptrdiff_t>(count));
    _nextState += count;
}

}  // namespace Rabit
