#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "KeyInput.h"
#include "PlayedFiles.h"
#include "ReplayFleet.h"
#include "Wakeup.h"
#include "recording/replay/ReplayTimeline.h"

namespace Rabit::Tool
{

// Plays a time line with a fleet, controlled by the keys of the terminal.
class Playing
{
public:
    using Duration = std::chrono::nanoseconds;

    // All arguments must outlive the object.
    Playing(PlayedFiles &files, const Replay::ReplayTimeline::Settings &settings, ReplayFleet &fleet,
            Wakeup &wakeup);

    // Plays to the end, or until a person ends it. Returns the exit code.
    int Run();
    std::uint64_t Rounds() const { return _timeline.Rounds(); }

private:
    // Between two looks at the nodes and their problems.
    static constexpr Duration Look = std::chrono::milliseconds(200);
    static constexpr Replay::Time Leap = 10'000'000'000;

    void PlayDue();
    bool LookAround();
    void Wait();
    void Obey();
    void Obey(char key);
    std::string Place() const;

    const PlayedFiles &_files;
    const Replay::Time _end;
    ReplayFleet &_fleet;
    Wakeup &_wakeup;
    Replay::ReplayTimeline _timeline;
    KeyInput _keys;
    std::optional<char> _key;
    std::uint64_t _jumps = 0;
    Duration _nextLook{0};
    bool _quits = false;
};

}  // namespace Rabit::Tool
