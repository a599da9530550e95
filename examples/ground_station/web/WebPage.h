#pragma once

#include "AircraftFollower.h"
#include "EventLog.h"
#include "NodeState.h"
#include "PageRequest.h"
#include "RadioWatch.h"
#include "StationData.h"
#include "WebServer.h"

#include <rabit/RabitManager.h>
#include <rabit/gateway/Fleet.h>

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace Ground
{

// Shows the fleet on a page in the browser, and accepts orders from it: the manager `WebPage`.
//
// Fetches: Gateway/Fleet, from which it learns the nodes; the messages of each aircraft that AircraftFollower
//          lists; CommandList, CommandTally, AreaList and Geofence of the Commander.
// Queue:   Pictures takes Uav::Picture, from whichever aircraft has one.
// Sends:   Ground::Order and Uav::SearchArea to the queue Commands, as the page asks.
//
// Ten times a second it sends all data to every open page, with the age of each part. A node counts as an
// aircraft once a pose or mission state of it has come, or if it is expected.
class WebPage : public Rabit::RabitManager
{
public:
    static constexpr std::chrono::milliseconds Period{100};
    // Number of nodes that are followed; others are not shown.
    static constexpr std::size_t MaxNodes = 200;
    // Orders and search areas of all pages together within one second; further ones are refused.
    // An order to all aircraft is one for each, and a person may correct it at once.
    static constexpr int MaxOrdersPerSecond = 2 * static_cast<int>(MaxNodes);
    static constexpr int PicturesWaiting = 64;

    struct Settings
    {
        std::string Node = "ground";  // of this ground station
        std::vector<std::string> Expected;
        RateLimits MaxRates{};  // of its configuration
    };

    WebPage(Settings settings, std::unique_ptr<WebServer> server,
            Rabit::RabitWorkspace &workspace = *Rabit::RabitWorkspace::GetWorkspace());
    ~WebPage() override;

    void Startup() final;
    void ExecuteUnitOfWork() final;
    void Shutdown() final;

private:
    struct TakenPicture
    {
        std::uint32_t Number = 0;
        double TakenGpsS = 0;  // by the clock of the aircraft
        double ArrivedS = 0;   // by the workspace's clock
    };
    // Used on the server's thread alone.
    struct OrderRate
    {
        double SecondBeganS = 0;
        int Orders = 0;
    };

    double NowS() const;
    void TakePictures();
    void Look();
    void FollowNewNodes();
    void Show(AircraftData &data, AircraftFollower &follower) const;
    std::string Answer(const std::string &text);
    std::string Obey(const PageRequest &request);

    const Settings _settings;
    std::string _life;
    std::uint64_t _number = 0;
    StationData _data;
    EventLog _events;
    RadioWatch _radio;
    std::map<std::string, std::unique_ptr<AircraftFollower>, NaturalOrder> _followers;
    std::map<std::string, TakenPicture> _pictures;
    OrderRate _rate;
    std::shared_ptr<RabitQueue> _pictureQueue;
    std::shared_ptr<Rabit::Gateway::Fleet> _fleet = std::make_shared<Rabit::Gateway::Fleet>();
    std::shared_ptr<CommandList> _commands = std::make_shared<CommandList>();
    std::shared_ptr<CommandTally> _tally = std::make_shared<CommandTally>();
    std::shared_ptr<Uav::Geofence> _fence = std::make_shared<Uav::Geofence>();
    std::shared_ptr<AreaList> _areas = std::make_shared<AreaList>();
    const std::unique_ptr<WebServer> _server;  // last, as its thread uses the others
};

}  // namespace Ground
