// The real web page over a scripted fleet, for the tests in a browser:
//   web_fixture AIRCRAFT [hostile|secured|noarea|poser] [PORT]
// Prints the page's address, then each order that it gets. Lines on the standard input change the fleet:
// `stale NODE`, `lost NODE`, `up NODE`, `beatless NODE` (it is STALE, but its poses arrive), `progress STEP
// [REASON]` (the last command comes to this step, a number of Ground::CommandProgress), `decline NODE REASON`
// (the search area), `orders NODE` (it is back without), `problems COUNT` (the number of problems now),
// `radio held` (it has a budget, and two in five posts of Pose and some messages for uav2 are held back),
// `nofix NODE` (its position is 0, 0), `noplace NODE` (its position is no number), `badplace NODE` (its
// latitude is 95), `goodplace NODE` (neither any more), `far NODE` (it is 60 km away), `noheart NODE` (its
// Health stops), `radio free` (not limited), `replay NODE` (it plays a recording), `fararea` (the search area
// is 3336 km away), `silence` (nothing is posted any more). With `poser` the last aircraft posts nothing but
// poses. The program ends when the lines end. The ground is at 430 m, and each aircraft has a floor of 460 m.
#include "AreaLog.h"
#include "WebPage.h"
#include "WebServer.h"

#include <rabit/RabitReactor.h>
#include <rabit/gateway/GatewayManager.h>

#include <cmath>
#include <cstdlib>
#include <ctime>
#include <deque>
#include <exception>
#include <iostream>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <numbers>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace
{
using Rabit::Gateway::NodeState;

// A grey picture of 16 by 12 dots.
const std::vector<std::uint8_t> SmallJpeg = {
    0xFF, 0xD8, 0xFF, 0xE0, 0x00, 0x10, 0x4A, 0x46, 0x49, 0x46, 0x00, 0x01, 0x01, 0x00, 0x00, 0x01,
    0x00, 0x01, 0x00, 0x00, 0xFF, 0xDB, 0x00, 0x43, 0x00, 0x1B, 0x12, 0x14, 0x17, 0x14, 0x11, 0x1B,
    0x17, 0x16, 0x17, 0x1E, 0x1C, 0x1B, 0x20, 0x28, 0x42, 0x2B, 0x28, 0x25, 0x25, 0x28, 0x51, 0x3A,
    0x3D, 0x30, 0x42, 0x60, 0x55, 0x65, 0x64, 0x5F, 0x55, 0x5D, 0x5B, 0x6A, 0x78, 0x99, 0x81, 0x6A,
    0x71, 0x90, 0x73, 0x5B, 0x5D, 0x85, 0xB5, 0x86, 0x90, 0x9E, 0xA3, 0xAB, 0xAD, 0xAB, 0x67, 0x80,
    0xBC, 0xC9, 0xBA, 0xA6, 0xC7, 0x99, 0xA8, 0xAB, 0xA4, 0xFF, 0xC0, 0x00, 0x0B, 0x08, 0x00, 0x0C,
    0x00, 0x10, 0x01, 0x01, 0x11, 0x00, 0xFF, 0xC4, 0x00, 0x16, 0x00, 0x01, 0x01, 0x01, 0x00, 0x00,
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x04, 0x05, 0xFF, 0xC4,
    0x00, 0x19, 0x10, 0x00, 0x01, 0x05, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,
    0x00, 0x00, 0x00, 0x00, 0x02, 0x13, 0x14, 0x51, 0x61, 0xFF, 0xDA, 0x00, 0x08, 0x01, 0x01, 0x00,
    0x00, 0x3F, 0x00, 0x92, 0x0E, 0x08, 0x38, 0x6F, 0x34, 0x8A, 0x0D, 0x22, 0x8F, 0xFF, 0xD9};

// Markup that a page must show as text, wherever it comes from.
constexpr const char *Markup = "<img src=x onerror=\"window.pwned=1\"><script>window.pwned=1</script>";

// Lines of the standard input, read by a thread of its own.
class Script
{
public:
    void Add(std::string line)
    {
        const std::lock_guard lock(_mutex);
        _lines.push_back(std::move(line));
    }
    bool Take(std::string &line)
    {
        const std::lock_guard lock(_mutex);
        if (_lines.empty())
            return false;
        line = std::move(_lines.front());
        _lines.pop_front();
        return true;
    }

private:
    std::mutex _mutex;
    std::deque<std::string> _lines;
};

struct FlyingAircraft
{
    std::string Node;
    NodeState State = NodeState::UP;
    bool Flies = true;
    bool HasFix = true;     // else its position is 0, 0
    bool HasPlace = true;   // else its position is no number
    bool IsOnEarth = true;  // else its latitude is 95
    double NorthDeg = 0;    // added to its latitude
    bool HasHealth = true;  // else it posts none any more
    float Battery = 0;      // percent; 0: the script says nothing of it
    double UnseenS = 0;     // of its target
    std::shared_ptr<Uav::Pose> Pose = std::make_shared<Uav::Pose>();
    std::shared_ptr<Uav::MissionState> Mission = std::make_shared<Uav::MissionState>();
    std::shared_ptr<Uav::Health> Health = std::make_shared<Uav::Health>();
    std::shared_ptr<Uav::Findings> Findings = std::make_shared<Uav::Findings>();
    std::shared_ptr<Uav::Targets> Targets = std::make_shared<Uav::Targets>();
    std::shared_ptr<Uav::CameraView> Camera = std::make_shared<Uav::CameraView>();
};

// Posts the messages of a gateway, and stands in for the Commander.
class ScriptedFleet : public Rabit::RabitManager
{
public:
    ScriptedFleet(int aircraft, bool hostile, bool hasArea, bool hasPoser, Script &script)
        : RabitManager("Commands"),
          _hostile(hostile),
          _hasArea(hasArea),
          _hasPoser(hasPoser),
          _script(script),
          _aircraft(static_cast<std::size_t>(aircraft))
    {
        AddPublishSubscribeMessage(Rabit::FleetMessageName, _fleet);
        AddPublishSubscribeMessage("AreaList", _areas);
        AddPublishSubscribeMessage("Geofence", _fence);
        AddPublishSubscribeMessage("CommandList", _commands);
        AddPublishSubscribeMessage("CommandTally", _tally);
        for (std::size_t i = 0; i < _aircraft.size(); ++i)
        {
            FlyingAircraft &one = _aircraft[i];
            one.Node = "uav" + std::to_string(i + 1);
            AddPublishSubscribeMessage(one.Node + "/Pose", one.Pose);
            AddPublishSubscribeMessage(one.Node + "/MissionState", one.Mission);
            AddPublishSubscribeMessage(one.Node + "/Health", one.Health);
            AddPublishSubscribeMessage(one.Node + "/Findings", one.Findings);
            AddPublishSubscribeMessage(one.Node + ".vision/Targets", one.Targets);
            AddPublishSubscribeMessage(one.Node + ".vision/CameraView", one.Camera);
        }
        SetWakeupTimeDelayMSec(100);
    }

    void Startup() final
    {
        _area->latitude_deg = 47.3977;
        _area->longitude_deg = 8.5456;
        _area->north_m = 400;
        _area->east_m = 600;
        _area->altitude_m = 510;
        _area->speed_mps = 16;
        _area->lane_m = 60;
        _area->number = 1;
        if (_hasArea)
            PostArea();
    }

    void ExecuteUnitOfWork() final
    {
        ObeyScript();
        TakeOrders();
        if (_silent)
            return;
        ++_step;
        PostFleet();
        PostAreas();
        for (std::size_t i = 0; i < _aircraft.size(); ++i)
            if (_aircraft[i].Flies)
                Fly(_aircraft[i], static_cast<int>(i));
    }

private:
    void ObeyScript()
    {
        std::string line;
        while (_script.Take(line))
        {
            std::istringstream words(line);
            std::string what;
            std::string node;
            words >> what >> node;
            if (what == "silence")
                _silent = true;
            if (what == "fararea")
                PutAreaFarAway();
            if (what == "radio")
                _held = node == "held";
            if (what == "replay")
                _replayed = node;
            if (what == "fence")
                SetFence(std::stod(node));
            if (what == "problems")
                SetProblems(std::stoul(node));
            std::string text;
            std::getline(words >> std::ws, text);
            if (what == "progress" && !_commands->items.empty())
                Advance(_commands->items.back(), static_cast<Ground::CommandProgress>(std::stoi(node)), text);
            if (what == "orders")
                SetWithoutOrders(node);
            for (FlyingAircraft &one : _aircraft)
                if (one.Node == node)
                    Happen(one, what, text);
        }
    }
    static void Happen(FlyingAircraft &one, const std::string &what, const std::string &text)
    {
        if (what == "decline")
            one.Mission->area_declined = text;
        if (what == "battery")
            one.Battery = std::stof(text);
        if (what == "unseen")
            one.UnseenS = std::stod(text);
        if (what == "nofix")
            one.HasFix = false;
        if (what == "noplace")
            one.HasPlace = false;
        if (what == "badplace")
            one.IsOnEarth = false;
        if (what == "goodplace")
            one.HasPlace = one.IsOnEarth = true;
        if (what == "far")
            one.NorthDeg = 0.54;
        if (what == "noheart")
            one.HasHealth = false;
        if (what == "up" || what == "stale" || what == "lost" || what == "beatless")
        {
            one.Flies = what == "up" || what == "beatless";
            one.State = what == "up" ? NodeState::UP : what == "lost" ? NodeState::LOST : NodeState::STALE;
        }
    }
    void SetWithoutOrders(const std::string &node)
    {
        Ground::NodeCommands commands;
        commands.node = node;
        commands.without_orders = true;
        _tally->nodes = {commands};
        _tally->PostMessage();
    }
    void Advance(Ground::CommandStatus &command, Ground::CommandProgress progress, const std::string &reason)
    {
        command.progress = progress;
        command.reason = reason;
        Ground::CommandStep step;
        step.progress = progress;
        step.reason = reason;
        command.steps.push_back(step);
        _commands->PostMessage();
    }
    void SetFence(double radiusM)
    {
        _fence->latitude_deg = _area->latitude_deg;
        _fence->longitude_deg = _area->longitude_deg;
        _fence->radius_m = radiusM;
        _fence->PostMessage();
    }
    void PutAreaFarAway()
    {
        _area->latitude_deg = 17.3977;
        ++_area->number;
        PostArea();
    }
    double NowS() const { return _step * 0.1; }
    void PostArea()
    {
        _areaLog.Given(*_area, NowS());
        PostAreas();
    }
    // As the Commander does.
    void PostAreas()
    {
        std::vector<Ground::AreaReport> reports;
        for (const FlyingAircraft &one : _aircraft)
            if (one.Mission->WasPosted())
                reports.push_back({one.Node, one.State == NodeState::LOST, one.Mission->search_area,
                                   one.Mission->area_declined, NowS()});
        _areaLog.Look(reports);
        if (_areaLog.Areas() == _areas->items)
            return;
        _areas->posted_s = NowS();
        _areas->items = _areaLog.Areas();
        _areas->PostMessage();
    }
    void SetProblems(std::size_t count)
    {
        _fleet->problems.resize(count);
        for (std::size_t i = 0; i < count; ++i)
        {
            _fleet->problems[i].node = "uav" + std::to_string(i + 1);
            _fleet->problems[i].subject = "subscribe Pse";
            _fleet->problems[i].reason = _fleet->problems[i].node + " does not publish `Pse`";
        }
    }
    void TakeOrders()
    {
        std::shared_ptr<Rabit::RabitMessage> message;
        while (GetManagerMessageQueue()->GetMessage(message))
        {
            if (const auto *const order = dynamic_cast<const Ground::Order *>(message.get()))
            {
                std::cout << "order " << static_cast<int>(order->kind) << ' ' << order->node << ' '
                          << order->latitude_deg << ' ' << order->longitude_deg << ' ' << order->altitude_m
                          << std::endl;
                Ground::CommandStatus status;
                status.id = status.number = static_cast<std::uint32_t>(_commands->items.size() + 1);
                status.node = order->node;
                status.kind = order->kind;
                status.latitude_deg = order->latitude_deg;
                status.longitude_deg = order->longitude_deg;
                status.altitude_m = order->altitude_m;
                _commands->items.push_back(status);
                Advance(_commands->items.back(),
                        _hostile ? Ground::CommandProgress::PROGRESS_DECLINED
                                 : Ground::CommandProgress::PROGRESS_DELIVERED,
                        _hostile ? Markup : "");
            }
            else if (auto *const area = dynamic_cast<Uav::SearchArea *>(message.get()))
            {
                std::cout << "area " << area->latitude_deg << ' ' << area->longitude_deg << ' '
                          << area->north_m << ' ' << area->east_m << ' ' << area->altitude_m << std::endl;
                area->number = _area->number + 1;
                _area->CopyMessage(area);
                PostArea();
            }
        }
    }
    void PostFleet()
    {
        _fleet->nodes.clear();
        for (const FlyingAircraft &one : _aircraft)
        {
            Rabit::Gateway::NodeStatus status;
            status.node = one.Node;
            status.state = one.State;
            status.replay = one.Node == _replayed;
            status.round_trip_s = 0.004;
            status.delivery_rate = _hostile ? std::numeric_limits<double>::infinity() : 3210;
            if (one.State != NodeState::UP)
                status.reason = _hostile ? Markup : "not heard";
            _fleet->nodes.push_back(status);
        }
        if (_hostile)
        {
            _fleet->problems.resize(1);
            for (auto &problem : _fleet->problems)
                problem.subject = problem.reason = problem.node = Markup;
        }
        SetRadio();
        _fleet->PostMessage();
    }
    void SetRadio()
    {
        const bool held = _held || _hostile;
        auto &air = _fleet->air;
        air.budget = held ? 5000 : 0;
        air.used = held ? 4940 : 1230;
        air.telemetry = held ? 4240 : 830;
        air.presence = 400;
        air.discovery = held ? 300 : 0;
        air.bulk = _hostile ? std::numeric_limits<double>::quiet_NaN() : 0;
        _fleet->publications.resize(1);
        auto &pose = _fleet->publications.front();
        pose.message = _hostile ? Markup : "Pose";
        ++pose.offered;
        pose.replaced += held && _step % 5 < 2 ? 1 : 0;
        _fleet->links.resize(1);
        auto &link = _fleet->links.front();
        link.node = _hostile ? Markup : "uav2";
        link.queue = "MissionControl";
        link.outbox = held ? 3 : 0;
        link.expired = held ? 2 : link.expired;
    }
    void Fly(FlyingAircraft &one, int index)
    {
        const double angle = _step * 0.01 + index * 0.7;
        const double radius = 60 + 12.0 * index;
        const double north = radius * std::cos(angle);
        const double east = radius * std::sin(angle);
        one.Pose->latitude_deg = 47.3977 + north / 111195;
        one.Pose->longitude_deg = 8.5456 + east / 75270;
        if (!one.HasFix)
            one.Pose->latitude_deg = one.Pose->longitude_deg = 0;
        one.Pose->latitude_deg += one.NorthDeg;
        if (!one.HasPlace)
            one.Pose->latitude_deg = one.Pose->longitude_deg = std::numeric_limits<double>::quiet_NaN();
        if (!one.IsOnEarth)
            one.Pose->latitude_deg = 95;
        one.Pose->altitude_m = 500 + index;
        one.Pose->velocity_north_mps = static_cast<float>(-std::sin(angle) * 12);
        one.Pose->velocity_east_mps = static_cast<float>(std::cos(angle) * 12);
        one.Pose->yaw_rad = static_cast<float>(angle + std::numbers::pi / 2);
        one.Pose->gps_time_s = 1000 + _step * 0.1;
        one.Pose->number = static_cast<std::uint32_t>(_step);
        one.Pose->PostMessage();
        if (_hasPoser && &one == &_aircraft.back())
            return;
        PostVision(one, index);
        if (_step % 10 != 1)
            return;
        one.Mission->mode = Uav::MissionMode::MISSION_SEARCH;
        if (one.Mission->area_declined.empty())
            one.Mission->search_area = _areaLog.Areas().empty() ? 0 : _area->number;
        one.Mission->text = _hostile ? Markup : "lane 2 of 7";
        one.Mission->target = _hostile ? "\"><svg onload=window.pwned=1>" : "";
        one.Mission->partner = one.Mission->target;
        one.Mission->has_floor = one.Mission->has_ground = one.Mission->has_home = true;
        one.Mission->floor_m = 460;
        one.Mission->ground_m = 430;
        one.Mission->home_latitude_deg = 47.395F;
        one.Mission->home_longitude_deg = 8.5456F;
        one.Mission->PostMessage();
        one.Health->battery_percent = one.Battery > 0 ? one.Battery : static_cast<float>(90 - index);
        one.Health->wants_home = _hostile;
        one.Health->reason = _hostile ? Markup : "";
        if (one.HasHealth)
            one.Health->PostMessage();
        auto picture = std::make_shared<Uav::Picture>();
        picture->taken_by = one.Node;
        picture->number = static_cast<std::uint32_t>(_step);
        picture->pose = *one.Pose;
        picture->jpeg = SmallJpeg;
        AddMessageToQueue("Pictures", picture);
    }
    void PostVision(FlyingAircraft &one, int index)
    {
        const Uav::Pose &pose = *one.Pose;
        const double half = 0.0003;
        for (int i = 0; i < 4; ++i)
        {
            one.Camera->corners[static_cast<std::size_t>(i)].latitude_deg =
                pose.latitude_deg + (i == 0 || i == 3 ? -half : half);
            one.Camera->corners[static_cast<std::size_t>(i)].longitude_deg =
                pose.longitude_deg + (i < 2 ? -half : half);
        }
        one.Camera->PostMessage();
        Uav::Target target;
        target.name.aircraft = one.Node;
        target.name.number = 1;
        target.found_by = one.Node;
        target.latitude_deg = 47.3977 + 0.0004 * (index % 5);
        target.longitude_deg = 8.5456 + 0.0006 * (index / 5);
        target.sigma_major_m = 8;
        target.sigma_minor_m = 4;
        target.seen_by = {_hostile ? "<b>uav</b>" : one.Node};
        one.Targets->items = {target};
        one.Targets->gps_time_s = target.seen_gps_time_s + one.UnseenS;
        one.Targets->PostMessage();
        Uav::Finding finding;
        finding.name = target.name;
        finding.stage = Uav::TargetStage::TARGET_VALIDATED;
        finding.validated_by = _hostile ? "<b>uav</b>" : "uav1";
        if (one.Findings->items.empty())
        {
            one.Findings->items = {finding};
            one.Findings->PostMessage();
        }
    }

    const bool _hostile;
    const bool _hasArea;
    const bool _hasPoser;
    Script &_script;
    std::vector<FlyingAircraft> _aircraft;
    bool _silent = false;
    bool _held = false;
    std::string _replayed;  // aircraft
    int _step = 0;
    std::shared_ptr<Rabit::Gateway::Fleet> _fleet = std::make_shared<Rabit::Gateway::Fleet>();
    std::shared_ptr<Uav::SearchArea> _area = std::make_shared<Uav::SearchArea>();
    Ground::AreaLog _areaLog;
    std::shared_ptr<Ground::AreaList> _areas = std::make_shared<Ground::AreaList>();
    std::shared_ptr<Uav::Geofence> _fence = std::make_shared<Uav::Geofence>();
    std::shared_ptr<Ground::CommandList> _commands = std::make_shared<Ground::CommandList>();
    std::shared_ptr<Ground::CommandTally> _tally = std::make_shared<Ground::CommandTally>();
};

void Serve(int aircraft, const std::string &kind, const std::string &port)
{
    Ground::WebServer::Settings settings;
    settings.Endpoint = Ground::ParseWebAddress(port);
    if (kind == "secured")
        settings.Secrets = Ground::MakeWebSecrets({{"localhost"}, {"127.0.0.1"}}, std::time(nullptr));
    auto server = std::make_unique<Ground::WebServer>(settings);
    for (const std::string &line : server->Addresses())
        std::cout << line << std::endl;

    Script script;
    Rabit::RabitReactor reactor;
    reactor.AddManager(std::make_unique<ScriptedFleet>(aircraft, kind == "hostile", kind != "noarea",
                                                       kind == "poser", script));
    reactor.AddManager(std::make_unique<Ground::WebPage>(Ground::WebPage::Settings{}, std::move(server)));
    std::thread reader(
        [&]
        {
            std::string line;
            while (std::getline(std::cin, line))
                script.Add(line);
            reactor.ShutdownAllManagers();
        });
    reactor.Run();
    reader.join();
}
}  // namespace

int main(int argc, char **argv)
{
    try
    {
        Serve(argc > 1 ? std::atoi(argv[1]) : 3, argc > 2 ? argv[2] : "plain", argc > 3 ? argv[3] : "0");
        return 0;
    }
    catch (const std::exception &error)
    {
        std::cerr << "web_fixture: " << error.what() << '\n';
        return 1;
    }
}
