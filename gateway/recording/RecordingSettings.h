#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace Rabit
{

// Where recordings go and how much of them is kept.
struct RecordingSettings
{
    std::string Name;    // of the node: files are called <Name>_<number>_<date>.mcap
    std::string Folder;  // for messages to people
    // A file that has become that large, or spans that much time, is ended, and the next one begun.
    std::uint64_t SplitBytes = std::uint64_t{1} << 30;
    std::chrono::nanoseconds SplitTime = std::chrono::minutes(10);
    // Bytes of all files of that name together, earlier recordings included; beyond it the oldest is removed.
    // 0: no bound.
    std::uint64_t KeepBytes = 0;
    // Bytes of the disk that stay free. With less, nothing is recorded.
    std::uint64_t FreeBytes = std::uint64_t{1} << 30;
    // True: the oldest files of this recording are removed to keep FreeBytes free. Files of earlier
    // recordings are not.
    bool RemovesOwnStart = false;
    // Bytes that may wait for the disk.
    std::size_t MemoryBytes = 64U << 20;
    bool Compresses = true;
    // If set, nothing is written until an event (BlackBox).
    struct BlackBoxTimes
    {
        std::chrono::nanoseconds Before{0};
        std::chrono::nanoseconds After{0};
    };
    std::optional<BlackBoxTimes> BlackBox{};
};

}  // namespace Rabit
