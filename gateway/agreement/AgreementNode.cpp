#include "agreement/AgreementNode.h"

#include <rabit/base/Fnv1a.h>
#include <rabit/base/LittleEndian.h>

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

namespace Rabit
{
namespace
{

AgreementSettings CheckedAgreement(AgreementSettings settings)
{
    if (!settings.IsMember(settings.Self) || settings.Members.size() > AgreementSettings::MostMembers ||
        settings.Lease <= AgreementSettings::Duration(0))
    {
        throw std::invalid_argument(
            "an agreement needs a list of at most 64 members, this node among them, and a "
            "lease above 0");
    }
    std::sort(settings.Members.begin(), settings.Members.end());
    return settings;
}

std::uint32_t LifeOf(std::uint64_t incarnation, std::uint32_t session)
{
    return Fnv1a().AddNumber(incarnation).AddNumber(session).Folded();
}

}  // namespace

AgreementNode::AgreementNode(AgreementSettings settings, std::uint64_t fences,
                             std::function<std::uint64_t()> random, Duration now)
    : _settings(CheckedAgreement(std::move(settings))),
      _group(_settings.Group()),
      _own(_settings, std::move(random)),
      _ballots(_settings, fences, now)
{
}

void AgreementNode::OnDatagram(std::string_view from, std::span<const std::uint8_t> bytes, Duration now)
{
    if (const auto request = DecodeClaimRequest(bytes))
    {
        if (const auto answer = Vote(from, *request, now))
        {
            Answer(from, *answer);
        }
    }
    else if (const auto reply = DecodeClaimReply(bytes))
    {
        _own.OnReply(from, *reply, now);
    }
    else
    {
        ++_malformed;
    }
}

std::optional<ClaimReply> AgreementNode::Vote(std::string_view from, const ClaimRequest &request,
                                              Duration now)
{
    bool waits = false;
    auto reply = _ballots.OnRequest(from, request, now, &waits);
    if (waits)
    {
        _unstored.insert_or_assign(std::string(from), request);
    }
    if (reply && from == _settings.Self)
    {
        _own.OnReply(from, *reply, now);
        reply.reset();
    }
    return reply;
}

void AgreementNode::Stored(std::uint64_t upTo, bool isStored, Duration now)
{
    _ballots.Stored(upTo, isStored);
    for (const auto &[from, request] : std::exchange(_unstored, {}))
    {
        if (const auto answer = Vote(from, request, now))
        {
            Answer(from, *answer);
        }
    }
}

std::vector<AgreementNode::Datagram> AgreementNode::Leave(Duration now)
{
    std::vector<Datagram> last;
    for (const OwnClaims::Outgoing &orders : _own.Leave(now))
    {
        if (orders.To != _settings.Self)
        {
            last.push_back({orders.To, EncodeClaimRequest(orders.Request)});
        }
    }
    return last;
}

void AgreementNode::Answer(std::string_view to, const ClaimReply &reply)
{
    if (_answers.size() >= MostAnswers)
    {
        _answers.pop_front();
    }
    _answers.push_back({std::string(to), EncodeClaimReply(reply)});
}

void AgreementNode::AnswerInBeat(std::string_view to, const ClaimReply &reply)
{
    // A longer number would be taken for another book.
    if (reply.Book <= std::numeric_limits<std::uint32_t>::max())
    {
        std::erase_if(_beatAnswers, [to](const auto &other) { return other.first == to; });
        _beatAnswers.emplace_back(std::string(to), reply);
    }
}

AgreementNode::Beat AgreementNode::TakeBeat(Duration now, bool renews, std::size_t mostAnswers)
{
    Beat beat;
    if (const auto request = renews ? _own.RenewByBeat(now) : std::nullopt)
    {
        LittleEndian::Put(request->Session, beat.Renewal);
        LittleEndian::Put(request->Renewal, beat.Renewal);
        static_cast<void>(Vote(_settings.Self, *request, now));
    }
    for (std::size_t left = std::min(AnswersForBeat(), mostAnswers); left > 0; --left)
    {
        const auto &[claimant, reply] = _beatAnswers.front();
        const auto place = std::lower_bound(_settings.Members.begin(), _settings.Members.end(), claimant);
        beat.Answers.push_back(static_cast<std::uint8_t>(place - _settings.Members.begin()));
        LittleEndian::Put(LifeOf(reply.Claimant, reply.Session), beat.Answers);
        LittleEndian::Put(static_cast<std::uint32_t>(reply.Book), beat.Answers);
        LittleEndian::Put(reply.Renewal, beat.Answers);
        _beatAnswers.pop_front();
    }
    return beat;
}

void AgreementNode::OnBeat(std::string_view from, std::uint64_t incarnation, const Beat &beat, Duration now)
{
    if (beat.Renewal.size() == RenewalBytes)
    {
        std::span<const std::uint8_t> renewal(beat.Renewal);
        ClaimRequest request{.Group = _group, .Incarnation = incarnation};
        request.Session = LittleEndian::Take<std::uint32_t>(renewal);
        request.Renewal = LittleEndian::Take<std::uint32_t>(renewal);
        if (const auto answer = Vote(from, request, now))
        {
            _settings.RidesInBeats ? AnswerInBeat(from, *answer) : Answer(from, *answer);
        }
    }
    TakeAnswers(from, incarnation, beat.Answers, now);
}

void AgreementNode::TakeAnswers(std::string_view from, std::uint64_t incarnation,
                                std::span<const std::uint8_t> answers, Duration now)
{
    while (answers.size() >= AnswerBytes)
    {
        const auto place = LittleEndian::Take<std::uint8_t>(answers);
        const auto life = LittleEndian::Take<std::uint32_t>(answers);
        ClaimReply reply{.Group = _group, .Incarnation = incarnation, .Claimant = _settings.Incarnation};
        reply.Session = _own.Session();
        reply.Book = LittleEndian::Take<std::uint32_t>(answers);
        reply.Renewal = LittleEndian::Take<std::uint32_t>(answers);
        if (place < _settings.Members.size() && _settings.Members[place] == _settings.Self &&
            life == LifeOf(reply.Claimant, reply.Session))
        {
            _own.OnReply(from, reply, now);
        }
    }
}

std::optional<AgreementNode::Duration> AgreementNode::Due() const
{
    return _answers.empty() ? _own.Due() : std::optional(Duration(0));
}

std::optional<AgreementNode::Datagram> AgreementNode::TakeDue(Duration now)
{
    if (!_answers.empty())
    {
        Datagram answer = std::move(_answers.front());
        _answers.pop_front();
        return answer;
    }
    while (const auto due = _own.TakeDue(now))
    {
        if (due->To.empty() || due->To == _settings.Self)
        {
            static_cast<void>(Vote(_settings.Self, due->Request, now));
        }
        if (due->To != _settings.Self && _settings.Members.size() > 1)
        {
            return Datagram{due->To, EncodeClaimRequest(due->Request)};
        }
    }
    return std::nullopt;
}

}  // namespace Rabit
