#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace Ground
{

// The latest picture of each aircraft, as JPEG. Bounded: MaxNodes pictures of MaxBytes each. Any thread.
class PictureStore
{
public:
    static constexpr std::size_t MaxNodes = 100;
    static constexpr std::size_t MaxBytes = 100'000;

    using Jpeg = std::shared_ptr<const std::vector<std::uint8_t>>;

    // Returns false, and keeps nothing, if it does not begin like a JPEG, is too large, or there are too
    // many aircraft.
    bool Put(const std::string &node, std::vector<std::uint8_t> jpeg);
    // Null if there is none.
    Jpeg Get(const std::string &node) const;

private:
    mutable std::mutex _mutex;
    std::map<std::string, Jpeg> _pictures;
};

}  // namespace Ground
