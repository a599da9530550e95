#pragma once

#include <rabit/gateway/GatewayConfig.h>

#include <string>

namespace Rabit
{

// How a recording is written.
struct RecordingSettings
{
    std::string Name;  // of the node: files are called <Name>_<number>_<date>.mcap
    RecordSettings Record{};
    // True: the oldest files of this recording are removed to keep Record.Free bytes free. Files of earlier
    // recordings are not. False: with less, nothing is recorded.
    bool RemovesOwnStart = false;
    bool Compresses = true;
};

}  // namespace Rabit
