#include "MemberManager.h"

#include "../common/Usage.h"

#include <algorithm>

namespace Rabit::Bench
{

std::string MemberNode(std::size_t member)
{
    return std::string("n").append(std::to_string(member));
}

MemberManager::MemberManager(const BenchOptions &options)
    : RabitManager("MemberManager"), _score(options), _period(options.Period), _due(Now() + options.Period)
{
    _own->padding.assign(options.Padding(), 0x5a);
    AddPublishSubscribeMessage(MemberMessage, _own);
    for (std::size_t member = 1; member <= options.Members; ++member)
    {
        if (member != options.Member)
        {
            const auto message = std::make_shared<::Bench::Sample>();
            AddPublishSubscribeMessage(MemberNode(member) + '/' + MemberMessage, message);
            WakeUpManagerOnMessagePost(message);
            _others.emplace_back(member, message);
        }
    }
    SetWakeupTimeDelaySec(static_cast<double>(_period) * 1e-9);
}

void MemberManager::ExecuteUnitOfWork()
{
    for (const auto &[member, message] : _others)
    {
        if (message->FetchMessage() && message->WasPosted())
        {
            _score.Heard(member);
        }
    }
    PostIfDue();
    _score.ReportIfAsked();
}

void MemberManager::PostIfDue()
{
    const std::int64_t now = Now();
    if (now >= _due)
    {
        ++_own->number;
        _own->sent_ns = now;
        _own->PostMessage();
        _score.Sent();
        _due = std::max(_due + _period, now);
    }
    SetWakeupTimeDelaySec(std::max(static_cast<double>(_due - now) * 1e-9, 1e-6));
}

}  // namespace Rabit::Bench
