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
    // Overwrites what is there. Throws std::runtime_error if that does not work. `beginning` is what time 0
    // of the frames is, since 1970.
    PcapFile(const std::string &path, Time beginning);
    // False: no longer written, for instance on a full disk.
    bool Write(Time at, const Frame &frame);

private:
    std::ofstream _file;
    Time _beginning;
};

}  // namespace Rabit::Radio
