// Random samples of any type, made by its shape: every value that the type allows is possible.
#pragma once

#include <rabit/dynamic/Shape.h>

#include <cstdint>
#include <random>
#include <vector>

// Returns a valid sample in one of the byte orders.
std::vector<std::uint8_t> RandomSample(const Rabit::Dynamic::Shape &root, bool littleEndian,
                                       std::mt19937 &random);
