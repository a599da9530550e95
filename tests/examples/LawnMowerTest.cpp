#include "mission/LawnMower.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <set>
#include <vector>

namespace
{
using Swarm::Between;
using Swarm::GeoPoint;
using Swarm::LawnMower;
using Swarm::Offset;

const GeoPoint Middle{47.4, 8.5, 510};

Uav::SearchArea Area(float northM, float eastM, float laneM)
{
    Uav::SearchArea area;
    area.latitude_deg = Middle.LatitudeDeg;
    area.longitude_deg = Middle.LongitudeDeg;
    area.altitude_m = 510;
    area.north_m = northM;
    area.east_m = eastM;
    area.lane_m = laneM;
    return area;
}

// Flies straight at each point that the mower gives, 5 m at a time. Returns all places.
std::vector<Offset> Fly(LawnMower &mower, Offset from, int steps)
{
    std::vector<Offset> places;
    GeoPoint place = Moved(Middle, from);
    for (int i = 0; i < steps; ++i)
    {
        const Offset way = Between(place, mower.Next(place));
        const double length = std::hypot(way.NorthM, way.EastM);
        place = Moved(place, {5 * way.NorthM / length, 5 * way.EastM / length, 0});
        places.push_back(Between(Middle, place));
    }
    return places;
}

TEST(LawnMower, LaysLanesAlongTheLongerSideNoFurtherApartThanAsked)
{
    EXPECT_EQ(LawnMower(Area(200, 600, 50), 0, 1).Lanes(), 4u);
    EXPECT_EQ(LawnMower(Area(201, 600, 50), 0, 1).Lanes(), 5u);
    EXPECT_EQ(LawnMower(Area(600, 40, 50), 0, 1).Lanes(), 1u);
    LawnMower north(Area(600, 100, 50), 0, 1);
    const auto places = Fly(north, {-400, 0, 0}, 100);
    EXPECT_NEAR(places.back().EastM, -25, 3) << "on the first lane, which runs north";
}

TEST(LawnMower, LooksAtEveryPlaceOfTheArea)
{
    LawnMower mower(Area(400, 600, 60), 0, 1);
    const auto places = Fly(mower, {-300, 0, 0}, 1800);
    for (double north = -200; north <= 200; north += 20)
        for (double east = -300; east <= 300; east += 20)
        {
            double nearest = 1e9;
            for (const Offset &place : places)
                nearest = std::min(nearest, std::hypot(place.NorthM - north, place.EastM - east));
            EXPECT_LT(nearest, 45)  // what a camera sees to its side at 80 m
                << north << " " << east;
        }
}

TEST(LawnMower, StartsAtTheNearerEnd)
{
    LawnMower fromEast(Area(200, 600, 50), 0, 1);
    EXPECT_GT(Between(Middle, fromEast.Next(Moved(Middle, {-300, 100, 0}))).EastM, 290);
    LawnMower fromWest(Area(200, 600, 50), 0, 1);
    EXPECT_LT(Between(Middle, fromWest.Next(Moved(Middle, {-300, -100, 0}))).EastM, -290);
}

TEST(LawnMower, HasBegunOnceItIsAtItsFirstLane)
{
    LawnMower mower(Area(200, 600, 50), 0, 1);
    Fly(mower, {-400, -300, 0}, 10);
    EXPECT_FALSE(mower.HasBegun());
    Fly(mower, {-80, -300, 0}, 1);
    EXPECT_TRUE(mower.HasBegun());
}

TEST(LawnMower, SpreadsAircraftOverTheLanes)
{
    std::set<std::size_t> lanes;
    for (std::size_t rank = 0; rank < 3; ++rank)
        lanes.insert(LawnMower(Area(400, 600, 60), rank, 3).Lane());
    EXPECT_EQ(lanes, (std::set<std::size_t>{0, 2, 4}));
    EXPECT_LT(LawnMower(Area(50, 600, 50), 19, 20).Lane(), 1u) << "more aircraft than lanes";
}

TEST(LawnMower, EachAircraftGoesThroughAllLanes)
{
    LawnMower mower(Area(200, 300, 50), 1, 2);
    std::set<std::size_t> seen;
    GeoPoint place = Moved(Middle, {0, -200, 0});
    for (int i = 0; i < 800; ++i)
    {
        const Offset way = Between(place, mower.Next(place));
        const double length = std::hypot(way.NorthM, way.EastM);
        place = Moved(place, {5 * way.NorthM / length, 5 * way.EastM / length, 0});
        seen.insert(mower.Lane());
    }
    EXPECT_EQ(seen.size(), 4u);
}

TEST(LawnMower, ComesBackToWhereItWasInterrupted)
{
    LawnMower mower(Area(200, 600, 50), 0, 1);
    const auto places = Fly(mower, {-75, -300, 0}, 60);  // nearly to the middle
    ASSERT_NEAR(places.back().EastM, 0, 10);
    mower.Interrupt();
    const Offset back = Between(Middle, mower.Next(Moved(Middle, {80, 250, 0})));
    EXPECT_NEAR(back.EastM, places.back().EastM, 6);
    EXPECT_NEAR(back.NorthM, -75, 1);
    EXPECT_EQ(mower.Lane(), 0u);
}

TEST(LawnMower, AimsFarEnoughAheadNotToCircle)
{
    LawnMower mower(Area(200, 600, 50), 0, 1);
    GeoPoint place = Moved(Middle, {-75, -300, 0});
    for (int i = 0; i < 500; ++i)
    {
        const Offset way = Between(place, mower.Next(place));
        const double length = std::hypot(way.NorthM, way.EastM);
        ASSERT_GT(length, LawnMower::NearM) << "at step " << i;
        place = Moved(place, {5 * way.NorthM / length, 5 * way.EastM / length, 0});
    }
}

}  // namespace
