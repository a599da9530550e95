// The pictures that a simulated camera takes.
#pragma once

#include "Camera.h"
#include "World.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace Swarm
{

// Red, green and blue, row by row from the upper left.
struct Image
{
    std::size_t Width = 0;
    std::size_t Height = 0;
    std::vector<std::uint8_t> Rgb;
};

// The ground in that view, 320 by 240 pixels, with the targets as orange discs. A place on the ground looks
// the same from every view. The upper edge is forward.
Image Photograph(const Footprint &view, const World &world, double gpsTimeS);

// The picture as a JPEG file. Empty if the library refuses it.
std::vector<std::uint8_t> EncodeJpeg(const Image &image, int quality = 75);

}  // namespace Swarm
