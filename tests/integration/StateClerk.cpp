#include "StateClerk.h"

#include <rabit/gateway/GatewayManager.h>

#include <sstream>

namespace TestNode
{
namespace
{

constexpr int WorkPeriodMSec = 5;

std::string NameOf(std::size_t state)
{
    return "State" + std::to_string(state);
}

}  // namespace

StateClerk::StateClerk(const StateOptions &options, const Orders &orders)
    : RabitManager("StateClerk"), _options(options), _orders(orders), _ledger(options.LedgerFile)
{
    AddPublishSubscribeMessage(Rabit::FleetMessageName, _fleet);
    for (std::size_t i = 0; i < _options.Count && _options.Posts > 0; ++i)
    {
        _own.push_back(std::make_shared<Ledger::Tick>());
        _own.back()->padding.assign(_options.Size, 0x5a);
        AddPublishSubscribeMessage(NameOf(i), _own.back());
    }
    SetWakeupTimeDelayMSec(WorkPeriodMSec);
}

void StateClerk::Configure(const StateOptions &options, Rabit::GatewayConfig &config)
{
    for (std::size_t i = 0; i < options.Count; ++i)
    {
        if (options.Posts > 0)
        {
            config.Publish.push_back({NameOf(i), "Ledger::Tick"});
        }
        config.Subscribe.push_back({NameOf(i), "Ledger::Tick"});
    }
}

void StateClerk::ExecuteUnitOfWork()
{
    if (_fleet->FetchMessage())
        FollowFleet();
    Post();
    FollowStates();
}

void StateClerk::FollowFleet()
{
    for (const auto &node : _fleet->nodes)
    {
        for (std::size_t i = 0; i < _options.Count; ++i)
        {
            auto &state = _others[{node.node, i}];
            if (!state)
            {
                state = std::make_shared<Ledger::Tick>();
                AddPublishSubscribeMessage(node.node + "/" + NameOf(i), state);
            }
        }
    }
    for (const auto &publication : _fleet->publications)
    {
        std::uint64_t &written = _written[publication.message];
        if (written != publication.written)
        {
            written = publication.written;
            _ledger.Line("state_samples message=" + publication.message +
                         " written=" + std::to_string(written));
        }
    }
}

void StateClerk::Post()
{
    const std::uint64_t wanted = (_options.Posts + _orders.States()) * _own.size();
    if (_posts >= wanted || Now() < _nextPost)
        return;
    _nextPost = Now() + _options.PeriodNs / static_cast<std::int64_t>(_own.size());
    const std::size_t which = _posts++ % _own.size();
    Ledger::Tick &state = *_own[which];
    ++state.number;
    _ledger.Line("state_posted message=" + NameOf(which) + " number=" + std::to_string(state.number));
    state.PostMessage();
}

void StateClerk::FollowStates()
{
    for (auto &[origin, state] : _others)
    {
        if (!state->FetchMessage() || !state->WasPosted())
            continue;
        std::ostringstream line;
        line << "state from=" << origin.first << " message=" << NameOf(origin.second)
             << " number=" << state->number << " age_s=" << state->GetAgeSeconds();
        _ledger.Line(line.str());
    }
}

}  // namespace TestNode
