#pragma once

#include <rabit/transport/Transport.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>

namespace Rabit
{

// How many sessions of each node the transport knows: beside the present one those of lives that ended
// without a word, until their leases have run out. What is sent to a node goes to each of them.
//
// Bounded: an event that says that a session went may be lost, and then it stays.
class NodeSessions
{
public:
    static constexpr std::size_t Most = 4096;

    void On(const PeerEvent &event)
    {
        if (event.What == PeerEvent::Kind::Appeared)
        {
            if (_count < Most)
            {
                _count += _sessions[event.Node].insert(event.Incarnation).second ? 1 : 0;
            }
            return;
        }
        const auto node = _sessions.find(event.Node);
        if (node != _sessions.end())
        {
            _count -= node->second.erase(event.Incarnation);
            if (node->second.empty())
            {
                _sessions.erase(node);
            }
        }
    }

    // 1 of a node that is not known.
    std::size_t Of(std::string_view node) const
    {
        const auto found = _sessions.find(node);
        return found == _sessions.end() ? 1 : found->second.size();
    }

private:
    std::map<std::string, std::set<std::uint64_t>, std::less<>> _sessions;
    std::size_t _count = 0;
};

}  // namespace Rabit
