#pragma once

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "recording/replay/ReplayItem.h"

namespace Rabit::Replay
{

// Tells which nodes were there at a time, by recorded names and times. Its sources are the recorders' lists
// of nodes, once a second at least (Gateway/Fleet), and the messages of the nodes.
class ReplayPresence
{
public:
    // A recorder from which nothing comes for this long (3.5 s) has ended, and its lists no longer hold.
    static constexpr Time Silence = 3'500'000'000;

    // `recorders` are the nodes with streams of Gateway/Fleet.
    explicit ReplayPresence(std::set<std::string> recorders);

    // Forgets all: the replay has jumped.
    void Reset();
    // `recorder` recorded a message of that node at that time.
    void Heard(const std::string &node, const std::string &recorder, Time time);
    // A node in a recorder's list, and whether it was LOST.
    struct Known
    {
        std::string Node;
        bool IsLost = false;
    };
    // A gateway of the recorder had that list at that time. A recorder may have several gateways: one that
    // hears a node suffices.
    void Told(const std::string &recorder, const std::string &gateway, Time time,
              const std::vector<Known> &known);

    bool IsThere(const std::string &node, Time time) const;

private:
    struct View
    {
        Time At = 0;
        std::map<std::string, bool> IsLost;  // by node
    };
    bool IsRecorded(const std::string &recorder, Time time) const;

    const std::set<std::string> _recorders;
    std::map<std::string, Time> _signs;                          // the last one of each recorder
    std::map<std::string, Time> _heard;                          // the last message of each node
    std::map<std::pair<std::string, std::string>, View> _views;  // by recorder and gateway
};

}  // namespace Rabit::Replay
