#include "recording/replay/ReplayPresence.h"

#include <algorithm>
#include <utility>

namespace Rabit::Replay
{

ReplayPresence::ReplayPresence(std::set<std::string> recorders) : _recorders(std::move(recorders)) {}

void ReplayPresence::Reset()
{
    _signs.clear();
    _heard.clear();
    _views.clear();
}

void ReplayPresence::Heard(const std::string &node, const std::string &recorder, Time time)
{
    _heard[node] = std::max(_heard[node], time);
    _signs[recorder] = std::max(_signs[recorder], time);
}

void ReplayPresence::Told(const std::string &recorder, const std::string &gateway, Time time,
                          const std::vector<Known> &known)
{
    _signs[recorder] = std::max(_signs[recorder], time);
    View &view = _views[{recorder, gateway}];
    view.At = time;
    view.IsLost.clear();
    for (const Known &one : known)
    {
        view.IsLost[one.Node] = one.IsLost;
    }
}

bool ReplayPresence::IsRecorded(const std::string &recorder, Time time) const
{
    const auto sign = _signs.find(recorder);
    return sign != _signs.end() && time <= sign->second + Silence;
}

// A recorder is there while it records. A message of a node that is later than LOST in a recorder's list
// shows that the node is back.
bool ReplayPresence::IsThere(const std::string &node, Time time) const
{
    if (_recorders.count(node) > 0)
    {
        return IsRecorded(node, time);
    }
    const auto heard = _heard.find(node);
    bool isKnown = false;
    for (const auto &[name, view] : _views)
    {
        const auto state = view.IsLost.find(node);
        if (state == view.IsLost.end())
        {
            continue;
        }
        isKnown = true;
        if (IsRecorded(name.first, time) &&
            (!state->second || (heard != _heard.end() && heard->second > view.At)))
        {
            return true;
        }
    }
    return !isKnown && heard != _heard.end();
}

}  // namespace Rabit::Replay
