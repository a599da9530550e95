#include "ImageProcessing.h"

#include "vision/Picture.h"

#include <array>
#include <cstddef>
#include <optional>
#include <utility>

namespace Swarm
{

ImageProcessing::ImageProcessing(const Names &names, World world, std::uint64_t seed,
                                 Rabit::RabitWorkspace &workspace)
    : RabitManager(names.OwnVision("ImageProcessing"), workspace),
      _names(names),
      _world(std::move(world)),
      _camera(seed),
      _others(names, *this)
{
    AddPublishSubscribeMessage(names.Own("Pose"), _pose);
    AddPublishSubscribeMessage(names.OwnVision("CameraView"), _view);
}

void ImageProcessing::ExecuteUnitOfWork()
{
    if (_frameTimes.IsDue(*this))
        TakeFrame();
    Rabit::RabitTimer::SleepUntilDue(*this, {&_frameTimes});
}

void ImageProcessing::TakeFrame()
{
    _pose->FetchMessage();
    if (!_pose->WasPosted() || _pose->number == _poseUsed || _pose->GetAgeSeconds() > MaxPoseAgeS)
        return;
    _poseUsed = _pose->number;
    const std::optional<Footprint> view = Camera::LookDown(*_pose, _world.GroundM);
    if (!view)
        return;
    PostView(*view);
    SendDetections(*view);
    if (_pictureTimes.IsDue(*this))
        SendPicture(*view);
}

void ImageProcessing::PostView(const Footprint &view)
{
    constexpr std::array<Footprint::Place, 4> corners{{{-1, 1}, {1, 1}, {1, -1}, {-1, -1}}};
    ++_view->frame;
    _view->gps_time_s = _pose->gps_time_s;
    for (std::size_t i = 0; i < corners.size(); ++i)
    {
        const GeoPoint corner = view.At(corners[i]);
        _view->corners[i].latitude_deg = corner.LatitudeDeg;
        _view->corners[i].longitude_deg = corner.LongitudeDeg;
    }
    _view->PostMessage();
}

void ImageProcessing::SendDetections(const Footprint &view)
{
    auto seen = std::make_shared<Uav::Detections>();
    seen->seen_by = _names.Aircraft();
    seen->frame = _view->frame;
    seen->pose = *_pose;
    seen->items = _camera.Detect(view, _world, _pose->gps_time_s);
    if (seen->items.empty())
        return;
    AddMessageToQueue(_names.OwnVision("SensorFusion"), seen);
    for (const auto &[aircraft, pose] : _others.Poses())
        AddMessageToQueue(_names.Of(Names::VisionOf(aircraft), "SensorFusion"), seen);
}

void ImageProcessing::SendPicture(const Footprint &view)
{
    auto picture = std::make_shared<Uav::Picture>();
    picture->taken_by = _names.Aircraft();
    picture->number = ++_pictures;
    picture->pose = *_pose;
    picture->jpeg = EncodeJpeg(Photograph(view, _world, _pose->gps_time_s));
    AddMessageToQueue("*/Pictures", picture);
}

}  // namespace Swarm
