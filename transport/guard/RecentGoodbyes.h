// Remembers the participants that said goodbye.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <deque>

#include "guard/RtpsMessage.h"

namespace Rabit::Rtps
{

// A goodbye overtakes announcements that were sent before it on another socket, by milliseconds. The
// participant must not come back by them. But a goodbye may be forged, also where nodes have keys: nothing in
// it is signed. So a participant is accepted again if it still announces itself later. Bounded. Not
// thread-safe.
class RecentGoodbyes
{
public:
    using TimePoint = std::chrono::steady_clock::time_point;

    // How long the network's part ignores announcements behind a goodbye.
    static constexpr std::chrono::seconds Overtaken{2};
    // The same for sessions, behind that part. Shorter, so that a session accepts whatever the network's part
    // has let through: implementations report a participant once.
    static constexpr std::chrono::seconds OvertakenInSession{1};

    explicit RecentGoodbyes(std::chrono::milliseconds overtaken) : _overtaken(overtaken) {}

    // A repeated goodbye does not count, so that repetitions cannot keep a participant away for longer.
    void Note(const GuidPrefix &peer, TimePoint now)
    {
        constexpr std::size_t most = 64;  // no more sessions close at a time
        std::erase_if(_goodbyes, [&](const Goodbye &each) { return now - each.At >= _overtaken; });
        if (!Has(peer, now) && _goodbyes.size() < most)
        {
            _goodbyes.push_back({peer, now});
        }
    }
    bool Has(const GuidPrefix &peer, TimePoint now) const
    {
        return std::any_of(_goodbyes.begin(), _goodbyes.end(),
                           [&](const Goodbye &each)
                           { return each.Peer == peer && now - each.At < _overtaken; });
    }

private:
    struct Goodbye
    {
        GuidPrefix Peer{};
        TimePoint At{};
    };

    const std::chrono::milliseconds _overtaken;
    std::deque<Goodbye> _goodbyes;
};

}  // namespace Rabit::Rtps
