#include "vision/Camera.h"
#include "vision/Picture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace
{
using Swarm::Between;
using Swarm::Camera;
using Swarm::Footprint;
using Swarm::GeoPoint;
using Swarm::Image;
using Swarm::World;

const GeoPoint Ground{47.4, 8.5, 430};

Uav::Pose PoseAt(double heightM, double yawRad)
{
    Uav::Pose pose;
    pose.latitude_deg = Ground.LatitudeDeg;
    pose.longitude_deg = Ground.LongitudeDeg;
    pose.altitude_m = 430 + heightM;
    pose.yaw_rad = static_cast<float>(yawRad);
    pose.roll_rad = 0.5f;  // makes no difference
    return pose;
}

World WorldWith(const Swarm::Offset &place)
{
    return {430, {{Moved(Ground, place)}}};
}

TEST(Footprint, GrowsWithHeightAndLiesDownwards)
{
    const auto view = Camera::LookDown(PoseAt(100, 0), 430);
    ASSERT_TRUE(view);
    EXPECT_NEAR(view->HalfWidthM, 100 / std::sqrt(3.0), 1e-6);
    EXPECT_NEAR(view->HalfDepthM, 75 / std::sqrt(3.0), 1e-6);
    EXPECT_EQ(view->Centre.AltitudeM, 430);
}

TEST(Footprint, TurnsWithTheNose)
{
    const auto view = Camera::LookDown(PoseAt(100, std::numbers::pi / 2), 430);
    const auto forward = Between(view->Centre, view->At({0, 1}));
    EXPECT_NEAR(forward.EastM, view->HalfDepthM, 1e-3);
    EXPECT_NEAR(forward.NorthM, 0, 1e-3);
    const auto right = Between(view->Centre, view->At({1, 0}));
    EXPECT_NEAR(right.NorthM, -view->HalfWidthM, 1e-3);
}

TEST(Footprint, FindsWhatItPlaces)
{
    const auto view = Camera::LookDown(PoseAt(80, 0.7), 430);
    const auto place = view->Find(view->At({0.3, -0.8}));
    EXPECT_NEAR(place.Right, 0.3, 1e-4);
    EXPECT_NEAR(place.Forward, -0.8, 1e-4);
}

TEST(Camera, SeesNothingNearTheGround)
{
    EXPECT_FALSE(Camera::LookDown(PoseAt(4, 0), 430));
    EXPECT_FALSE(Camera::LookDown(PoseAt(-100, 0), 430));
}

TEST(Camera, SeesMostTargetsInItsViewWithTheErrorItStates)
{
    Camera camera(1);
    const auto view = Camera::LookDown(PoseAt(80, 0), 430);
    const World world = WorldWith({20, 10, 0});
    int near = 0;
    double squares = 0;
    for (int frame = 0; frame < 2000; ++frame)
    {
        for (const auto &seen : camera.Detect(*view, world, 0))
        {
            const auto error = Between(world.Targets[0].Start, {seen.latitude_deg, seen.longitude_deg, 430});
            EXPECT_NEAR(seen.sigma_m, 2.4, 1e-6);
            if (error.LengthM() > 15)
                continue;  // a false alarm
            ++near;
            squares += error.NorthM * error.NorthM + error.EastM * error.EastM;
        }
    }
    EXPECT_NEAR(near / 2000.0, Camera::SeenShare, 0.03);
    EXPECT_NEAR(std::sqrt(squares / near / 2), 2.4, 0.1);
}

TEST(Camera, SeesNothingOutsideItsViewButRareFalseAlarms)
{
    Camera camera(1);
    const auto view = Camera::LookDown(PoseAt(80, 0), 430);
    std::size_t seen = 0;
    for (int frame = 0; frame < 5000; ++frame)
        seen += camera.Detect(*view, WorldWith({60, 0, 0}), 0).size();
    EXPECT_NEAR(static_cast<double>(seen) / 5000, Camera::FalseAlarmsPerFrame, 0.006);
}

TEST(Camera, DetectsTheSameForTheSameSeed)
{
    Camera a(7);
    Camera b(7);
    const auto view = Camera::LookDown(PoseAt(80, 0), 430);
    for (int frame = 0; frame < 100; ++frame)
        EXPECT_EQ(a.Detect(*view, WorldWith({0, 0, 0}), 0), b.Detect(*view, WorldWith({0, 0, 0}), 0));
}

bool IsOrange(const Image &image, std::size_t column, std::size_t row)
{
    const std::uint8_t *pixel = &image.Rgb[(row * image.Width + column) * 3];
    return pixel[0] == 255 && pixel[1] == 110 && pixel[2] == 0;
}

TEST(Picture, ShowsATargetWhereItIs)
{
    const auto view = Camera::LookDown(PoseAt(80, 1.0), 430);
    const World world{430, {{view->At({0.5, 0.5})}}};
    const Image image = Photograph(*view, world, 0);
    ASSERT_EQ(image.Rgb.size(), 320u * 240 * 3);
    EXPECT_TRUE(IsOrange(image, 240, 60));
    EXPECT_FALSE(IsOrange(image, 80, 180));
}

TEST(Picture, ShowsTheSameGroundAtAPlaceWhereverTheAircraftIs)
{
    const auto here = Camera::LookDown(PoseAt(80, 0), 430);
    auto pose = PoseAt(80, 0);
    // The aircraft moves forward by 60 rows of the image.
    const GeoPoint moved = here->At({0, 0.5});
    pose.latitude_deg = moved.LatitudeDeg;
    pose.longitude_deg = moved.LongitudeDeg;
    const Image before = Photograph(*here, {430, {}}, 0);
    const Image after = Photograph(*Camera::LookDown(pose, 430), {430, {}}, 0);
    int different = 0;
    for (std::size_t i = 0; i < 180 * 320 * 3; ++i)
        different += std::abs(before.Rgb[i] - after.Rgb[i + 60 * 320 * 3]) > 3;
    EXPECT_LT(different, 180 * 320 * 3 / 100);
}

TEST(Picture, IsAJpegOfTenToFortyKilobytes)
{
    const auto jpeg = EncodeJpeg(Photograph(*Camera::LookDown(PoseAt(80, 0.3), 430), {430, {}}, 0));
    EXPECT_GT(jpeg.size(), 10'000u);
    EXPECT_LT(jpeg.size(), 40'000u);
    EXPECT_EQ(jpeg[0], 0xFF);
    EXPECT_EQ(jpeg[1], 0xD8);
    EXPECT_EQ(jpeg[jpeg.size() - 1], 0xD9);
}

TEST(Picture, OfAWrongSizeIsNotEncoded)
{
    EXPECT_TRUE(Swarm::EncodeJpeg({10, 10, {}}).empty());
}

}  // namespace
