#include "agreement/AgreementHub.h"

#include <utility>

namespace Rabit
{
namespace
{

constexpr std::string_view NoGateway = "no gateway runs with this configuration";

// Claims whose last refusal or loss is remembered.
constexpr std::size_t MostReasons = 4 * Claims::Most;

std::string ReasonOf(const OwnClaims::Event &event)
{
    switch (event.What)
    {
        case OwnClaims::Event::Kind::Gained:
            break;
        case OwnClaims::Event::Kind::Refused:
            return event.Holder.empty() ? "other nodes ask for it, too" : event.Holder + " has it";
        case OwnClaims::Event::Kind::NoMajority:
            return "no majority of the members has answered";
        case OwnClaims::Event::Kind::Lost:
            return "its lease has ended: no majority of the members has answered in time";
    }
    return "";
}

}  // namespace

bool AgreementHub::Want(const std::string &claim, bool keeps)
{
    {
        const std::lock_guard lock(_mutex);
        if (!_node)
        {
            return WantWithoutGateway(claim, keeps);
        }
        const TakesEvents taken(*this);
        const bool isWanted = _node->Own().IsWanted(claim);
        if (!_node->Own().Want(claim, keeps, _clock->Monotonic()))
        {
            return false;
        }
        if (!isWanted)
        {
            _reasons.erase(claim);
        }
    }
    Wake();
    return true;
}

bool AgreementHub::WantWithoutGateway(const std::string &claim, bool keeps)
{
    const auto known = _waiting.find(claim);
    if (known == _waiting.end() &&
        (claim.empty() || claim.size() > Claims::LongestName || _waiting.size() >= Claims::Most))
    {
        return false;
    }
    _waiting[claim] = keeps || (known != _waiting.end() && known->second);
    return true;
}

void AgreementHub::GiveUp(const std::string &claim)
{
    {
        const std::lock_guard lock(_mutex);
        _waiting.erase(claim);
        if (!_node || !_node->Own().IsWanted(claim))
        {
            return;
        }
        const TakesEvents taken(*this);
        _node->Own().GiveUp(claim, _clock->Monotonic());
        _reasons.erase(claim);
    }
    Wake();
}

std::optional<std::uint64_t> AgreementHub::FenceOf(std::string_view claim) const
{
    const std::lock_guard lock(_mutex);
    return _node ? _node->Own().FenceOf(claim, _clock->Monotonic()) : std::nullopt;
}

std::vector<std::string> AgreementHub::Mine() const
{
    const std::lock_guard lock(_mutex);
    return _node ? _node->Own().Held(_clock->Monotonic()) : std::vector<std::string>();
}

Claims::Status AgreementHub::StatusOf(std::string_view claim) const
{
    const std::lock_guard lock(_mutex);
    Claims::Status status;
    if (!_node)
    {
        status.IsWanted = _waiting.contains(std::string(claim));
        status.Reason = NoGateway;
        return status;
    }
    const Duration now = _clock->Monotonic();
    status.IsWanted = _node->Own().IsWanted(claim);
    status.Fence = _node->Own().FenceOf(claim, now);
    if (status.Fence)
    {
        status.Holder = _name;
        return status;
    }
    const auto reason = _reasons.find(claim);
    status.Reason = reason == _reasons.end() ? "" : reason->second;
    const auto holding = _node->Ballots().HolderOf(claim, now);
    if (holding && holding->Fence > 0 && holding->Holder != _name)
    {
        status.Holder = holding->Holder;
    }
    return status;
}

bool AgreementHub::Open(const AgreementSettings &settings, std::uint64_t fences, const RabitClock &clock,
                        std::function<std::uint64_t()> random, std::function<void()> wake)
{
    const std::scoped_lock lock(_mutex, _tableMutex);
    if (_node)
    {
        return false;
    }
    const Duration now = clock.Monotonic();
    _table.emplace(settings.Self, settings.Incarnation);
    _node.emplace(settings, fences, std::move(random), now);
    _clock = &clock;
    _wake = std::move(wake);
    _name = settings.Self;
    _reasons.clear();
    _events.clear();
    for (const auto &[claim, keeps] : std::exchange(_waiting, {}))
    {
        static_cast<void>(_node->Own().Want(claim, keeps, now));
    }
    return true;
}

std::vector<AgreementNode::Datagram> AgreementHub::Close()
{
    const std::scoped_lock lock(_mutex, _tableMutex);
    if (!_node)
    {
        return {};
    }
    for (const std::string &claim : _node->Own().Kept())
    {
        _waiting[claim] = true;
    }
    std::vector<AgreementNode::Datagram> last = _node->Leave(_clock->Monotonic());
    _node.reset();
    _table.reset();
    _clock = nullptr;
    _wake = nullptr;
    return last;
}

void AgreementHub::TakeEventsOfNode()
{
    for (OwnClaims::Event &event : _node->Own().TakeEvents())
    {
        const std::string reason = ReasonOf(event);
        if (reason.empty())
        {
            _reasons.erase(event.Claim);
        }
        else
        {
            if (_reasons.size() >= MostReasons && !_reasons.contains(event.Claim))
            {
                std::erase_if(_reasons,
                              [this](const auto &other) { return !_node->Own().IsWanted(other.first); });
            }
            _reasons[event.Claim] = reason;
        }
        _events.push_back(std::move(event));
    }
}

std::vector<OwnClaims::Event> AgreementHub::TakeEvents()
{
    const std::lock_guard lock(_mutex);
    return std::exchange(_events, {});
}

std::string_view AgreementHub::Write(const std::function<std::string_view(TableCopy &)> &change)
{
    std::string_view answer;
    {
        const std::lock_guard lock(_tableMutex);
        if (!_table)
        {
            return NoGateway;
        }
        answer = change(*_table);
    }
    TellTable();
    return answer;
}

std::optional<TableValue> AgreementHub::ValueOf(std::string_view key) const
{
    const std::lock_guard lock(_tableMutex);
    const TableValue *const value = _table ? _table->Find(key) : nullptr;
    return value == nullptr ? std::nullopt : std::optional(*value);
}

std::vector<std::string> AgreementHub::Keys() const
{
    const std::lock_guard lock(_tableMutex);
    std::vector<std::string> keys;
    for (const TableEntry &entry : _table ? _table->Entries() : std::vector<TableEntry>())
    {
        keys.push_back(entry.Key);
    }
    return keys;
}

void AgreementHub::TellTable()
{
    bool hasChanged = false;
    {
        const std::lock_guard lock(_tableMutex);
        hasChanged = _table && !_table->TakeChanged().empty();
    }
    if (hasChanged)
    {
        _tableChanged.Fire();
    }
}

void AgreementHub::Wake() const
{
    std::function<void()> wake;
    {
        const std::lock_guard lock(_mutex);
        wake = _wake;
    }
    if (wake)
    {
        wake();
    }
}

}  // namespace Rabit
