#include "common/SendingTurn.h"

#include <rabit/base/Fnv1a.h>

#include <algorithm>

namespace Rabit
{

bool SendingTurn::Begin(std::size_t most)
{
    if (_ofThread != nullptr)
    {
        return false;
    }
    _ofThread = this;
    _most = most;
    _taken = {};
    return true;
}

// The order of the destinations does not matter, so their numbers are added up.
void SendingTurn::Note(const Way &way)
{
    _taken.Number += Fnv1a().AddNumber(way.first).AddNumber(way.second).Sum();
    ++_taken.Count;
}

TurnDatagram *SendingTurn::LastOf(const Way &way)
{
    const auto found =
        std::find_if(_kept.rbegin(), _kept.rend(), [&way](const auto &kept) { return kept.first == way; });
    return found != _kept.rend() ? found->second.get() : nullptr;
}

void SendingTurn::End()
{
    const auto kept = std::exchange(_kept, {});
    Drop();
    for (const auto &each : kept)
    {
        each.second->Send();
    }
}

void SendingTurn::Drop()
{
    _kept.clear();
    _ofThread = _ofThread == this ? nullptr : _ofThread;
}

}  // namespace Rabit
