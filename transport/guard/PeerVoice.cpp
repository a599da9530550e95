#include "guard/PeerVoice.h"

#include <algorithm>

namespace Rabit::Rtps
{

namespace
{

// Subjects of claims: each endpoint, and a few more. If there are too many, an arbitrary one is forgotten.
constexpr std::size_t MostFromElsewhere = 1024;
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

void PeerVoice::Announced(std::span<const HostAddress> hosts, const HostAddress &from)
{
    if (!std::equal(hosts.begin(), hosts.end(), _hosts.begin(), _hosts.end()))
    {
        _hosts.assign(hosts.begin(), hosts.end());
        _heardThere = false;
        _others.clear();
        _fromElsewhere.clear();
    }
    if (Has(_hosts, from) || IsLoopback(from))
    {
        _heardThere = true;
        _others.clear();
    }
    else if (!_heardThere && !Has(_others, from))
    {
        if (_others.size() >= MostOthers)
        {
            _others.erase(_others.begin());
        }
        _others.push_back(from);
    }
}

bool PeerVoice::IsAt(const HostAddress &from) const
{
    return from == UnknownHost || IsLoopback(from) || Has(_hosts, from) || Has(_others, from);
}

// Forgets in a pseudorandom order, so that no forger keeps pace with it by chance.
void PeerVoice::ForgetOne()
{
    _chance = _chance * 6364136223846793005u + 1442695040888963407u;  // Knuth, MMIX
    auto forgotten = _fromElsewhere.lower_bound(_chance);
    forgotten = forgotten == _fromElsewhere.end() ? _fromElsewhere.begin() : forgotten;
    _fromElsewhere.erase(forgotten);
}

bool PeerVoice::Believes(const HostAddress &from, const Saying &saying)
{
    if (IsAt(from))
    {
        return true;
    }
    if (_fromElsewhere.size() >= MostFromElsewhere && _fromElsewhere.count(saying.About) == 0)
    {
        ForgetOne();
    }
    return _fromElsewhere[saying.About].IsRepeated(saying.Content);
}

}  // namespace Rabit::Rtps
