#include "agreement/AgreementNode.h"

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
    return settings;
}

}  // namespace

AgreementNode::AgreementNode(AgreementSettings settings, FenceStore &store,
                             std::function<std::uint64_t()> random, Duration now)
    : _settings(CheckedAgreement(std::move(settings))),
      _own(_settings, std::move(random)),
      _ballots(_settings, store, now)
{
}

void AgreementNode::OnDatagram(std::string_view from, std::span<const std::uint8_t> bytes, Duration now)
{
    if (const auto request = DecodeClaimRequest(bytes))
    {
        Vote(from, *request, now);
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

void AgreementNode::Vote(std::string_view from, const ClaimRequest &request, Duration now)
{
    const auto reply = _ballots.OnRequest(from, request, now);
    if (_ballots.LastIgnored() == ClaimBallots::Ignored::OtherGroup)
    {
        _otherGroups.insert_or_assign(std::string(from), now);
    }
    if (!reply)
    {
        return;
    }
    if (from == _settings.Self)
    {
        _own.OnReply(from, *reply, now);
        return;
    }
    if (_answers.size() >= MostAnswers)
    {
        _answers.pop_front();
    }
    _answers.push_back({std::string(from), EncodeClaimReply(*reply)});
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
            Vote(_settings.Self, due->Request, now);
        }
        if (due->To != _settings.Self && _settings.Members.size() > 1)
        {
            return Datagram{due->To, EncodeClaimRequest(due->Request)};
        }
    }
    return std::nullopt;
}

}  // namespace Rabit
