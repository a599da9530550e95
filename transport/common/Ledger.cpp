#include "common/Ledger.h"

#include <algorithm>
#include <utility>

namespace Rabit::Rtps
{

Ledger::Sum Ledger::StrangersBeside(const HostAddress &host) const
{
    Sum sum;
    for (const auto &[peer, account] : _accounts)
    {
        if (account.IsStranger())
        {
            ++sum.Participants;
            sum.Endpoints += account.Endpoints.size();
            sum.OfHost += account.Host == host ? 1 : 0;
            sum.EndpointsOfHost += account.Host == host ? account.Endpoints.size() : 0;
        }
    }
    return sum;
}

Ledger::Coming Ledger::Comes(const GuidPrefix &peer, const HostAddress &host, std::size_t bytes,
                             TimePoint now)
{
    const std::lock_guard lock(_mutex);
    if (_accounts.contains(peer))
    {
        return Coming::Known;
    }
    const Sum strangers = StrangersBeside(host);
    if (_accounts.size() >= Most || strangers.Participants >= MostStrangers ||
        strangers.OfHost >= MostStrangersOfHost)
    {
        Refuse(host, now);
        return Coming::Refused;
    }
    Account &account = _accounts[peer];
    account.Host = host;
    account.IsListed = _listed.contains(host);
    account.Add(static_cast<std::int64_t>(bytes));
    return Coming::New;
}

void Ledger::SetPlaces(const GuidPrefix &peer, std::span<const Place> places)
{
    const std::lock_guard lock(_mutex);
    const auto found = _accounts.find(peer);
    if (found != _accounts.end() &&
        !std::equal(places.begin(), places.end(), found->second.Named.begin(), found->second.Named.end()))
    {
        RemovePlaces(peer, found->second);
        found->second.Named.assign(places.begin(), places.end());
        found->second.Places.clear();
        PutPlaces(peer, found->second, places);
    }
}

void Ledger::PutPlaces(const GuidPrefix &peer, Account &account, std::span<const Place> places)
{
    for (const Place &place : places)
    {
        if (account.Places.size() < MostPlaces && _places.emplace(place, peer).second)
        {
            account.Places.push_back(place);
        }
    }
}

void Ledger::RemovePlaces(const GuidPrefix &peer, const Account &account)
{
    for (const Place &place : account.Places)
    {
        _places.erase({place, peer});
    }
}

bool Ledger::HasEndpoint(const GuidPrefix &peer, EntityId endpoint, std::span<const Place> places,
                         TimePoint now)
{
    const std::lock_guard lock(_mutex);
    const auto found = _accounts.find(peer);
    if (found == _accounts.end())
    {
        return false;
    }
    Account &account = found->second;
    if (!account.Endpoints.contains(endpoint))
    {
        const Sum strangers = account.IsStranger() ? StrangersBeside(account.Host) : Sum{};
        if (_endpoints >= MostEndpoints || account.Endpoints.size() >= MostEndpointsOfOne ||
            strangers.Endpoints >= MostEndpointsOfStrangers ||
            strangers.EndpointsOfHost >= MostEndpointsOfHost)
        {
            Refuse(account.Host, now);
            return false;
        }
        account.Endpoints.insert(endpoint);
        ++_endpoints;
    }
    PutPlaces(peer, account, places);
    return true;
}

void Ledger::EndpointGone(const GuidPrefix &peer, EntityId endpoint)
{
    _ofAuthority.Gone(peer, endpoint);
    const std::lock_guard lock(_mutex);
    const auto found = _accounts.find(peer);
    _endpoints -= found == _accounts.end() ? 0 : found->second.Endpoints.erase(endpoint);
}

void Ledger::Left(const GuidPrefix &peer)
{
    _ofAuthority.Left(peer);
    const std::lock_guard lock(_mutex);
    const auto found = _accounts.find(peer);
    if (found != _accounts.end())
    {
        RemovePlaces(peer, found->second);
        _endpoints -= found->second.Endpoints.size();
        _listeners -= found->second.Listens ? 1 : 0;
        _accounts.erase(found);
    }
}

void Ledger::Came(const GuidPrefix &peer, std::size_t bytes)
{
    const std::lock_guard lock(_mutex);
    const auto found = _accounts.find(peer);
    if (found != _accounts.end())
    {
        found->second.Add(static_cast<std::int64_t>(bytes + IpAndUdp));
    }
}

bool Ledger::Spoke(const GuidPrefix &peer)
{
    const std::lock_guard lock(_mutex);
    const auto found = _accounts.find(peer);
    return found != _accounts.end() && !std::exchange(found->second.HasSpoken, true);
}

void Ledger::Listens(const GuidPrefix &peer)
{
    const std::lock_guard lock(_mutex);
    const auto found = _accounts.find(peer);
    if (found != _accounts.end() && found->second.IsStranger() && _listeners < MostListeners)
    {
        found->second.Listens = true;
        ++_listeners;
    }
}

bool Ledger::IsStranger(const GuidPrefix &peer) const
{
    const std::lock_guard lock(_mutex);
    const auto found = _accounts.find(peer);
    return found == _accounts.end() || found->second.IsStranger();
}

Ledger::Going Ledger::MayGo(const Place &to, std::size_t bytes, Cargo cargo, TimePoint now)
{
    const auto cost = static_cast<std::int64_t>(bytes + IpAndUdp);
    const std::lock_guard lock(_mutex);
    Account *payer = nullptr;
    Account *stranger = nullptr;
    for (auto at = _places.lower_bound({to, GuidPrefix{}}); at != _places.end() && at->first == to; ++at)
    {
        stranger = &_accounts.at(at->second);
        if (!stranger->IsStranger() || stranger->IsListed)
        {
            return Going::Freely;
        }
        payer = payer == nullptr && stranger->Has(cost, cargo) ? stranger : payer;
    }
    if (payer != nullptr)
    {
        payer->Take(cost, cargo);
        return Going::AsToStranger;
    }
    if (stranger == nullptr && _listed.contains(to.Host))
    {
        return Going::Freely;
    }
    if (TakeAllowance(cost, cargo, now))
    {
        return Going::AsToStranger;
    }
    Refuse(stranger == nullptr ? to.Host : stranger->Host, now);
    return Going::Refused;
}

bool Ledger::TakeAllowance(std::int64_t bytes, Cargo cargo, TimePoint now)
{
    const auto since = std::chrono::duration_cast<std::chrono::milliseconds>(now - _filledAt).count();
    const std::int64_t filled = AllowanceRate * std::min<std::int64_t>(since, 1'000'000) / 1000;
    if (filled > 0)
    {
        _allowance = std::min(_allowance + filled, Allowance);
        _filledAt = now;
    }
    if (_allowance < bytes + (cargo == Cargo::Samples ? Allowance / 2 : 0))
    {
        return false;
    }
    _allowance -= bytes;
    return true;
}

void Ledger::Refuse(const HostAddress &host, TimePoint now)
{
    ++_refusals;
    if (_refused.size() >= MostHosts && !_refused.contains(host))
    {
        _refused.erase(std::min_element(_refused.begin(), _refused.end(),
                                        [](const auto &a, const auto &b)
                                        { return a.second.Last < b.second.Last; }));
    }
    Refusal &refusal = _refused[host];
    if (now - refusal.Last >= Pause)
    {
        refusal = {};
    }
    const auto second = [](TimePoint time)
    { return std::chrono::floor<std::chrono::seconds>(time.time_since_epoch()); };
    refusal.Seconds += second(now) != second(refusal.Last) ? 1 : 0;
    refusal.Last = now;
    ++refusal.Times;
}

std::vector<Ledger::Refused> Ledger::LastingRefusals(TimePoint now) const
{
    const std::lock_guard lock(_mutex);
    std::vector<Refused> lasting;
    for (const auto &[host, refusal] : _refused)
    {
        if (refusal.Seconds >= LastingSeconds && now - refusal.Last < Pause)
        {
            lasting.push_back({host, refusal.Times});
        }
    }
    return lasting;
}

std::uint64_t Ledger::Refusals() const
{
    const std::lock_guard lock(_mutex);
    return _refusals;
}

std::string Ledger::Refused::Address() const
{
    std::string text;
    for (const std::uint8_t part : Host)
    {
        text.append(text.empty() ? "" : ".").append(std::to_string(part));
    }
    return text;
}

}  // namespace Rabit::Rtps
