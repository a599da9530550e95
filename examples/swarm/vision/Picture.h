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

// The ground in that view, the same at each place however it is looked at, and the targets on it as orange
// discs, 320 by 240 pixels. The upper edge is forward.
Image Photograph(const Footprint &view, const World &world, double gpsTimeS);

// The picture as a JPEG file. Empty if the library refuses it.
std::vector<std::uint8_t> EncodeJpeg(const Image &image, int quality = 75);

}  // namespace Swarm
