#pragma once

#include "Names.h"
#include "OtherAircraft.h"
#include "uav.idl.h"
#include "vision/Camera.h"
#include "vision/World.h"

#include <rabit/RabitManager.h>
#include <rabit/RabitTimer.h>

#include <chrono>
#include <cstdint>
#include <memory>

namespace Swarm
{

// The camera of an aircraft and the recognition of targets in its frames, both simulated: the manager
// `ImageProcessing`.
//
// Fetches: Pose of its aircraft, at the moment of capture, and that of the others.
// Posts:   CameraView (Uav::CameraView), with each frame, twice a second.
// Sends:   each frame that shows anything, with that pose, as Uav::Detections to the queue SensorFusion of
//          its own aircraft and of each other one; a small JPEG every four seconds, as Uav::Picture to the
//          queue Pictures of every ground station.
//
// Without a new and fresh pose there is no frame.
class ImageProcessing : public Rabit::RabitManager
{
public:
    static constexpr std::chrono::milliseconds FramePeriod{500};
    static constexpr std::chrono::seconds PicturePeriod{4};
    static constexpr double MaxPoseAgeS = 1;

    // The seed decides which targets the camera misses.
    ImageProcessing(const Names &names, World world, std::uint64_t seed,
                    Rabit::RabitWorkspace &workspace = *Rabit::RabitWorkspace::GetWorkspace());

    void ExecuteUnitOfWork() final;

private:
    void TakeFrame();
    void PostView(const Footprint &view);
    void SendDetections(const Footprint &view);
    void SendPicture(const Footprint &view);

    const Names _names;
    const World _world;
    Camera _camera;
    OtherAircraft _others;
    Rabit::RabitTimer _frameTimes{FramePeriod};
    Rabit::RabitTimer _pictureTimes{PicturePeriod};
    std::uint32_t _poseUsed = 0;
    std::uint32_t _pictures = 0;
    std::shared_ptr<Uav::Pose> _pose = std::make_shared<Uav::Pose>();
    std::shared_ptr<Uav::CameraView> _view = std::make_shared<Uav::CameraView>();
};

}  // namespace Swarm
