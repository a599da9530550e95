#pragma once

#include <memory>
#include <string>
#include <vector>

#include "doctor/MachineFacts.h"
#include "doctor/NetworkFacts.h"

namespace Rabit::Tool::Doctor
{

// Tries the network, beside DDS, with sockets of its own: sends by multicast on each interface, listens where
// the participants of all domains announce themselves, and announces itself once in some of them, so that
// they answer. That costs some 180 bytes on the air for each domain and interface, and what each participant
// answers. All from the construction on, on a thread of its own.
class NetworkTrial
{
public:
    // `ownName`: a participant that is this program. `callIn`: the domains in which to ask.
    NetworkTrial(const std::vector<Interface> &interfaces, std::string ownName,
                 const std::vector<int> &callIn);
    ~NetworkTrial();
    NetworkTrial(const NetworkTrial &) = delete;
    NetworkTrial &operator=(const NetworkTrial &) = delete;

    // What has come of it by now.
    NetworkFacts Facts() const;

private:
    class Work;
    std::unique_ptr<Work> _work;
};

}  // namespace Rabit::Tool::Doctor
