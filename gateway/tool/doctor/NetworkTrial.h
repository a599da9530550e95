#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "doctor/MachineFacts.h"
#include "doctor/NetworkFacts.h"

namespace Rabit::Tool::Doctor
{

// Tries the network beside DDS, with sockets of its own. Sends by multicast on each interface, and listens
// where the participants of domains announce themselves. Also announces itself once in some domains, so that
// participants answer. In the first of them it does so each 0.8 s, seven times: a call or an answer may be
// lost. That costs some 190 bytes on the air for each call and interface, and the answers. While no node is
// heard there (IsNodeHeard), the next three calls also ask nodes with keys, which then introduce themselves.
// Listens from the construction on, on a thread of its own. On interfaces that are not used it only listens.
//
// A gateway over Cyclone DDS answers a newcomer by multicast, which cannot be told from its periodic
// announcement. It answers newcomers of an address alone once one of them has addressed it alone
// (DirectAnnouncements). So participants that were heard and did not answer also get a call of their own,
// from another participant of this address: its answers do not count.
//
// Also calls the participants of the first domain at the loopback address, three times: those that ROS 2
// limits to one machine (ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST) hear no multicast.
class NetworkTrial
{
public:
    // `used`, `unused`: interfaces of this machine. `ownName`: the participant of this program, which is
    // ignored. `callIn`: the domains in which to ask, the configured one first; `listenIn`: those in which to
    // listen. `ownSealedSessions`: OwnSealedSessions.
    NetworkTrial(const std::vector<Interface> &used, const std::vector<Interface> &unused,
                 std::string ownName, const std::vector<int> &callIn, const std::vector<int> &listenIn,
                 std::size_t ownSealedSessions);
    ~NetworkTrial();
    NetworkTrial(const NetworkTrial &) = delete;
    NetworkTrial &operator=(const NetworkTrial &) = delete;

    // The results so far.
    NetworkFacts Facts() const;

private:
    class Work;
    std::unique_ptr<Work> _work;
};

}  // namespace Rabit::Tool::Doctor
