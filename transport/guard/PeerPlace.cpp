#include "guard/PeerPlace.h"

#include <algorithm>

namespace Rabit::Rtps
{

namespace
{

constexpr int OftenEnough = 3;
// What is said of discovery: numbers of two writers, and a few more. When they are too many it begins anew.
constexpr std::size_t MostFromElsewhere = 256;
constexpr std::size_t MostOthers = 4;

bool Has(const std::vector<HostAddress> &hosts, const HostAddress &host)
{
    return std::find(hosts.begin(), hosts.end(), host) != hosts.end();
}

bool IsLoopback(const HostAddress &host)
{
    return host[0] == 127;
}

}  // namespace

void PeerPlace::Announced(std::span<const HostAddress> hosts, const HostAddress &from, bool anew)
{
    if (anew)
    {
        _hosts.assign(hosts.begin(), hosts.end());
        _heardThere = false;
        _others.clear();
        _fromElsewhere.clear();
    }
    if (Has(_hosts, from))
    {
        _heardThere = true;
        _others.clear();
    }
    else if (!_heardThere && !Has(_others, from) && _others.size() < MostOthers)
    {
        _others.push_back(from);
    }
}

bool PeerPlace::IsAt(const HostAddress &from) const
{
    return from == UnknownHost || IsLoopback(from) || Has(_hosts, from) || Has(_others, from);
}

bool PeerPlace::Believes(const HostAddress &from, const Saying &saying)
{
    if (IsAt(from))
    {
        return true;
    }
    if (_fromElsewhere.size() >= MostFromElsewhere && _fromElsewhere.count(saying.About) == 0)
    {
        _fromElsewhere.clear();
    }
    Repeated &repeated = _fromElsewhere[saying.About];
    repeated.Times = repeated.Content == saying.Content ? repeated.Times + 1 : 1;
    repeated.Content = saying.Content;
    repeated.Times = std::min(repeated.Times, OftenEnough);
    return repeated.Times >= OftenEnough;
}

}  // namespace Rabit::Rtps
