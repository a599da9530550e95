#include "Picture.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace Swarm
{
namespace
{
constexpr std::size_t Width = 320;
constexpr std::size_t Height = 240;
constexpr double TargetRadiusM = 2.5;
constexpr double RimM = 0.8;

using Colour = std::array<double, 3>;

// A pseudo-random number from 0 to 1 for a square of a grid.
double Hash(std::int64_t x, std::int64_t y, std::uint64_t salt)
{
    std::uint64_t h = static_cast<std::uint64_t>(x) * 0x9E3779B97F4A7C15u ^
                      static_cast<std::uint64_t>(y) * 0xC2B2AE3D27D4EB4Fu ^ salt * 0x165667B19E3779F9u;
    h = (h ^ (h >> 31)) * 0xD6E8FEB86659FD93u;
    h ^= h >> 32;
    return static_cast<double>(h >> 11) * 0x1p-53;
}

// The same, smooth between the corners of the squares.
double Noise(double northM, double eastM, double sizeM, std::uint64_t salt)
{
    const double x = northM / sizeM;
    const double y = eastM / sizeM;
    const auto x0 = static_cast<std::int64_t>(std::floor(x));
    const auto y0 = static_cast<std::int64_t>(std::floor(y));
    const auto ease = [](double u) { return u * u * (3 - 2 * u); };
    const double u = ease(x - std::floor(x));
    const double v = ease(y - std::floor(y));
    return std::lerp(std::lerp(Hash(x0, y0, salt), Hash(x0 + 1, y0, salt), u),
                     std::lerp(Hash(x0, y0 + 1, salt), Hash(x0 + 1, y0 + 1, salt), u), v);
}

// Fields of 70 m by 45 m, paths between them, bushes, and grain.
Colour GroundAt(double northM, double eastM)
{
    const double bentN = northM + 6 * Noise(northM, eastM, 40, 1);
    const double bentE = eastM + 6 * Noise(northM, eastM, 40, 2);
    const double n = bentN / 45;
    const double e = bentE / 70;
    const auto fieldN = static_cast<std::int64_t>(std::floor(n));
    const auto fieldE = static_cast<std::int64_t>(std::floor(e));
    const double crop = Hash(fieldN, fieldE, 3);
    Colour colour{60 + 80 * crop, 95 + 45 * Hash(fieldN, fieldE, 4), 45 + 25 * crop};
    const double edgeM = std::min((n - std::floor(n)) * 45, (e - std::floor(e)) * 70);
    if (edgeM < 2)
        colour = {150, 138, 112};
    else if (Noise(northM, eastM, 7, 5) > 0.8)
        colour = {38, 66, 34};
    const double grain = 0.75 + 0.3 * Noise(northM, eastM, 1.2, 6) + 0.2 * Noise(northM, eastM, 9, 7);
    for (double &part : colour)
        part *= grain;
    return colour;
}

// The image on the ground in metres from a corner of the degree net, which all views of one neighbourhood
// share. The earth is flat here, so that the steps from pixel to pixel are always the same.
struct Grid
{
    explicit Grid(const Footprint &view)
        : Origin{std::floor(view.Centre.LatitudeDeg), std::floor(view.Centre.LongitudeDeg),
                 view.Centre.AltitudeM},
          First(Between(Origin, view.At({-1 + 1.0 / Width, 1 - 1.0 / Height})))
    {
        const Offset right = Between(Origin, view.At({1 - 1.0 / Width, 1 - 1.0 / Height}));
        const Offset below = Between(Origin, view.At({-1 + 1.0 / Width, -1 + 1.0 / Height}));
        Column = {(right.NorthM - First.NorthM) / (Width - 1), (right.EastM - First.EastM) / (Width - 1), 0};
        Row = {(below.NorthM - First.NorthM) / (Height - 1), (below.EastM - First.EastM) / (Height - 1), 0};
    }
    Offset At(std::size_t column, std::size_t row) const
    {
        const auto x = static_cast<double>(column);
        const auto y = static_cast<double>(row);
        return {First.NorthM + x * Column.NorthM + y * Row.NorthM,
                First.EastM + x * Column.EastM + y * Row.EastM, 0};
    }

    GeoPoint Origin;
    Offset First;   // the upper left pixel
    Offset Column;  // from one to the next
    Offset Row;
};
}  // namespace

Image Photograph(const Footprint &view, const World &world, double gpsTimeS)
{
    const Grid grid(view);
    std::vector<Offset> targets;
    for (const WorldTarget &target : world.Targets)
    {
        const GeoPoint point = target.At(gpsTimeS);
        const Footprint::Place place = view.Find(point);
        if (std::abs(place.Right) < 1.5 && std::abs(place.Forward) < 1.5)
            targets.push_back(Between(grid.Origin, point));
    }
    Image image{Width, Height, {}};
    image.Rgb.reserve(Width * Height * 3);
    for (std::size_t row = 0; row < Height; ++row)
    {
        for (std::size_t column = 0; column < Width; ++column)
        {
            const Offset place = grid.At(column, row);
            Colour colour = GroundAt(place.NorthM, place.EastM);
            for (const Offset &target : targets)
            {
                const double distance = std::hypot(target.NorthM - place.NorthM, target.EastM - place.EastM);
                if (distance < TargetRadiusM)
                    colour = {255, 110, 0};
                else if (distance < TargetRadiusM + RimM)
                    colour = {20, 20, 20};
            }
            for (const double part : colour)
                image.Rgb.push_back(static_cast<std::uint8_t>(std::clamp(part, 0.0, 255.0)));
        }
    }
    return image;
}

}  // namespace Swarm
