#include "NodeCounters.h"

#include <algorithm>

namespace Rabit::Radio
{

void SecondWindow::Add(Time at, std::size_t bytes)
{
    while (!_last.empty() && at - _last.front().first >= std::chrono::seconds(1))
    {
        _sum -= _last.front().second;
        _last.pop_front();
    }
    _last.emplace_back(at, bytes);
    _sum += bytes;
    _most = std::max(_most, _sum);
}

void NodeCounters::OnAir(Time at, const Frame &frame, std::size_t overhead, Time waited)
{
    const std::size_t bytes = frame.size() + overhead;
    (IsMulticast(frame) ? Multicast : Unicast).Add(bytes);
    const std::size_t ip = IpBytes(frame);
    IpSent += ip;
    AirSecond.Add(at, bytes);
    IpSecond.Add(at, ip);
    LongestWait = std::max(LongestWait, waited);
    const Kind kind = KindOf(frame);
    const bool room = Kinds.size() < MostKinds || Kinds.contains(kind);
    Kinds[room ? kind : Kind{}].Add(bytes);
}

}  // namespace Rabit::Radio
