#pragma once

#include <rabit/PublishSubscribeClass.h>
#include <rabit/RabitClock.h>
#include <rabit/gateway/GatewayConfig.h>

#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "FleetSession.h"
#include "live/LiveServer.h"
#include "live/PanelMapping.h"

namespace Rabit::Tool
{

// Shows each post of the local messages that a FleetFollower has subscribed to, also in the form for panels,
// on the thread that posts it. Shows problems of Gateway/Fleet as they come and go. Functions are for the
// main thread.
class LiveTaps
{
public:
    // `except`: names and patterns of messages that are not shown. All arguments must outlive the object.
    LiveTaps(FleetSession &session, const GatewayConfig &config, const std::vector<std::string> &except,
             LiveServer &server);
    ~LiveTaps();

    // Taps new messages, and shows new problems.
    void Look();
    std::size_t Messages() const { return _taps.size(); }

private:
    class Tap;

    std::shared_ptr<Tap> MakeTap(const std::string &name);
    bool IsState(const std::string &node, const std::string &message) const;
    void TellProblems();

    FleetSession &_session;
    const std::vector<std::string> &_except;
    LiveServer &_server;
    std::vector<PanelMapping> _panels;
    std::map<std::string, std::shared_ptr<Tap>> _taps;  // by local name; null: it cannot be shown
    std::uint32_t _log;
    std::set<std::string> _problems;  // that were shown
};

}  // namespace Rabit::Tool
