#pragma once

// The headers that most tests include. Test programs share them as one precompiled header
// (tests/CMakeLists.txt). A test still includes what it uses, since the presets with sanitizers compile
// without.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/function.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <filesystem>
#include <fstream>
#include <functional>
#include <future>
#include <iostream>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <random>
#include <set>
#include <span>
#include <sstream>
#include <string>
#include <thread>
#include <unordered_map>
#include <vector>
