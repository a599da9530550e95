#pragma once

#include "Frame.h"
#include "NodeCounters.h"

#include <fstream>
#include <string>

namespace Rabit::Radio
{

// A recording for Wireshark or tcpdump: classic pcap with nanoseconds, Ethernet.
class PcapFile
{
public:
    // Overwrites an existing file. Throws std::runtime_error if the file cannot be written. `beginning` is
    // time 0 of the frames, as a time since 1970.
    PcapFile(const std::string &path, Time beginning);
    // Returns false if the file is no longer written, for instance on a full disk.
    bool Write(Time at, const Frame &frame);

private:
    std::ofstream _file;
    Time _beginning;
};

}  // namespace Rabit::Radio
