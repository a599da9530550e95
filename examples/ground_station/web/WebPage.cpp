#include "WebPage.h"

#include "ProblemLines.h"
#include "ReplayLine.h"
#include "Snapshot.h"

#include <rabit/gateway/GatewayManager.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string_view>
#include <utility>

namespace Ground
{
namespace
{
// Suffix of an aircraft's vision node, which is shown with the aircraft.
constexpr std::string_view VisionSuffix = ".vision";

bool IsVision(const std::string &node)
{
    return node.size() > VisionSuffix.size() &&
           std::string_view(node).substr(node.size() - VisionSuffix.size()) == VisionSuffix;
}
}  // namespace

WebPage::WebPage(Settings settings, std::unique_ptr<WebServer> server, Rabit::RabitWorkspace &workspace)
    : RabitManager("WebPage", workspace),
      _settings(std::move(settings)),
      _radio(_settings.MaxRates),
      _pictureQueue(std::make_shared<RabitQueue>(PicturesWaiting, "Pictures")),
      _server(std::move(server))
{
    AddPublishSubscribeMessage(Rabit::FleetMessageName, _fleet);
    AddPublishSubscribeMessage("CommandList", _commands);
    AddPublishSubscribeMessage("CommandTally", _tally);
    AddPublishSubscribeMessage("AreaList", _areas);
    AddPublishSubscribeMessage("Geofence", _fence);
    AddManagerMessageQueue("Pictures", _pictureQueue);
    for (const std::string &node : _settings.Expected)
        _followers[node] = std::make_unique<AircraftFollower>(node, workspace);
    SetWakeupTimeDelayMSec(static_cast<int>(Period.count()));
}

WebPage::~WebPage() = default;

void WebPage::Startup()
{
    std::random_device random;
    _life = std::to_string(random()) + std::to_string(random());
    _number = 0;
    _events = EventLog();
    _server->Start([this](const std::string &text) { return Answer(text); });
}

void WebPage::ExecuteUnitOfWork()
{
    TakePictures();
    Look();
    _events.Look(_data);
    _server->Broadcast(std::make_shared<const std::string>(SnapshotText(_data, _events.Events())));
}

void WebPage::Shutdown()
{
    _server->Stop();
}

double WebPage::NowS() const
{
    return std::chrono::duration<double>(GetWorkspace().GetClock().Monotonic()).count();
}

void WebPage::TakePictures()
{
    std::shared_ptr<Rabit::RabitMessage> message;
    while (_pictureQueue->GetMessage(message))
    {
        const auto *const picture = dynamic_cast<const Uav::Picture *>(message.get());
        if (picture == nullptr || !IsNodeName(picture->taken_by) ||
            !_server->Pictures().Put(picture->taken_by, picture->jpeg))
            continue;  // the page shows the growing age of the last good one
        _pictures[picture->taken_by] = {picture->number, picture->pose.gps_time_s, NowS()};
    }
}

void WebPage::Look()
{
    _fleet->FetchMessage();
    FollowNewNodes();
    _data.Node = _settings.Node;
    _data.Life = _life;
    _data.Number = ++_number;
    _data.FleetAgeS = _fleet->GetAgeSeconds();
    _data.Areas = Latest(*_areas);
    _data.Fence = Latest(*_fence);
    _data.Commands = Latest(*_commands);
    _tally->FetchMessage();
    _data.Problems = AllProblems(*_fleet);
    _data.Replayed = ReplayedNodes(*_fleet);
    if (_fleet->WasPosted())
        _radio.Look(*_fleet, _fleet->GetPostTime().Monotonic);
    _data.Radio = _radio.Use();
    _data.Aircraft.clear();
    for (const auto &[node, follower] : _followers)
    {
        AircraftData data;
        data.Node = node;
        Show(data, *follower);
        const bool expected =
            std::find(_settings.Expected.begin(), _settings.Expected.end(), node) != _settings.Expected.end();
        if (expected || data.Pose || data.Mission || !data.BadPosition.empty())
            _data.Aircraft.push_back(std::move(data));
    }
    _data.NowS = NowS();
}

void WebPage::FollowNewNodes()
{
    for (const auto &status : _fleet->nodes)
        if (!IsVision(status.node) && !_followers.contains(status.node) && _followers.size() < MaxNodes)
            _followers[status.node] = std::make_unique<AircraftFollower>(status.node, GetWorkspace());
}

void WebPage::Show(AircraftData &data, AircraftFollower &follower) const
{
    data.State = StateOf(*_fleet, _data.FleetAgeS, data.Node);
    if (const auto *const status = StatusOf(*_fleet, data.Node))
    {
        data.Reason = status->reason;
        data.Replay = status->replay;
        data.HeardS = status->last_heard_s + _data.FleetAgeS;
        data.RoundTripS = status->round_trip_s;
        data.Path = status->path;
        data.DeliveryRate = status->delivery_rate > 0 ? status->delivery_rate : AircraftData::Unknown;
    }
    for (const NodeCommands &commands : _tally->nodes)
        if (commands.node == data.Node)
            data.WithoutOrders = commands.without_orders;
    follower.Show(data);
    const auto picture = _pictures.find(data.Node);
    if (picture == _pictures.end())
        return;
    // The clock of the aircraft may have been set meanwhile, so the age is at least the time since arrival.
    const double sinceArrivalS = NowS() - picture->second.ArrivedS;
    const double sinceTakenS = follower.SecondsSince(picture->second.TakenGpsS);
    data.Picture = {picture->second.Number,
                    std::isfinite(sinceTakenS) ? std::max(sinceTakenS, sinceArrivalS) : sinceArrivalS};
}

// Runs on the server's thread.
std::string WebPage::Answer(const std::string &text)
{
    const PageRequest request = ParsePageRequest(text);
    if (const auto *const clock = std::get_if<ClockRequest>(&request.Wish))
        return ClockReply(*clock, NowS());
    std::string refusal = request.Refusal;
    if (refusal.empty())
        refusal = Obey(request);
    return refusal.empty() && request.Ref ? AcceptedReply(*request.Ref) : RefusedReply(request.Ref, refusal);
}

// Passes the request on. Returns the reason if it was refused; empty if it was accepted.
std::string WebPage::Obey(const PageRequest &request)
{
    if (NowS() - _rate.SecondBeganS >= 1)
        _rate = {NowS(), 0};
    if (++_rate.Orders > MaxOrdersPerSecond)
        return "too many orders within a second";
    bool added = false;
    if (const auto *const order = std::get_if<Order>(&request.Wish))
        added = AddMessageToQueue("Commands", std::make_shared<Order>(*order));
    else if (const auto *const area = std::get_if<Uav::SearchArea>(&request.Wish))
        added = AddMessageToQueue("Commands", std::make_shared<Uav::SearchArea>(*area));
    return added ? "" : "the ground station takes no orders now";
}

}  // namespace Ground
