#pragma once

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "recording/replay/ReplayItem.h"

namespace Rabit::Replay
{

// Who was there when, as far as recordings tell: by what recorders knew of the others, once a second at least
// (Gateway/Fleet), and by their own messages. By recorded names and times.
class ReplayPresence
{
public:
    // A recorder of which nothing comes for so long has ended, and with it what it knew.
    static constexpr Time Silence = 3'500'000'000;

    // Of these nodes there are streams of Gateway/Fleet.
    explicit ReplayPresence(std::set<std::string> recorders);

    // What was told so far no longer holds: the replay has jumped.
    void Reset();
    // A message of that node was recorded then.
    void Heard(const std::string &node, const std::string &recorder, Time time);
    // The recorder knew then of these nodes, and of some of them that they were LOST.
    struct Known
    {
        std::string Node;
        bool IsLost = false;
    };
    // By the gateway of that name, of which it may have several: who is heard by one of them is there.
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
