#include "guard/PeerPlace.h"

#include <algorithm>

namespace Rabit::Rtps
{

namespace
{

constexpr int OftenEnough = 3;
// What is said of discovery: numbers of two writers, and a few more. When they are too many it begins anew.
constexpr std::size_t MostFromElsewhere = 1024;

}  // namespace

void PeerPlace::Announced(std::span<const HostAddress> hosts, const HostAddress &from, bool anew)
{
    const bool tells = std::find(hosts.begin(), hosts.end(), from) != hosts.end();
    if (!anew && !tells)
    {
        return;  // anybody can repeat it
    }
    _hosts.assign(hosts.begin(), hosts.end());
    if (!tells)
    {
        _hosts.push_back(from);
    }
    if (anew)
    {
        _fromElsewhere.clear();
    }
}

bool PeerPlace::IsAt(const HostAddress &from) const
{
    return from == UnknownHost || std::find(_hosts.begin(), _hosts.end(), from) != _hosts.end();
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
