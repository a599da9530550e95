// Samples of any type, made by its shape: every value that the type allows may come.
#pragma once

#include "dynamic/Shape.h"

#include <cstdint>
#include <random>
#include <vector>

// A valid sample in one of the byte orders.
std::vector<std::uint8_t> RandomSample(const Rabit::Dynamic::Shape &root, bool littleEndian,
                                       std::mt19937 &random);
