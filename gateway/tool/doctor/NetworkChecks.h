#pragma once

#include <rabit/gateway/GatewayConfig.h>

#include <cstddef>
#include <set>
#include <string>
#include <vector>

#include "RosNodes.h"
#include "doctor/Finding.h"
#include "doctor/MachineFacts.h"
#include "doctor/NetworkFacts.h"

// Problems of the network, by what NetworkTrial found. Pure.
namespace Rabit::Tool::Doctor
{

// Sessions of this program with keys: one on each path that has some.
std::size_t OwnSealedSessions(const GatewayConfig &config);
// True if a node was heard in the domain: one without keys, or, by the number of sessions with keys, another
// one than this program.
bool IsNodeHeard(const NetworkFacts &facts, int domain, std::size_t ownSealedSessions);

// Adds the names of their nodes to the labels of programs of ROS 2.
void NameRosPrograms(const RosNodes::Names &programs, NetworkFacts &facts);

// Judges multicast on the interfaces used, out and in. `heardBy`: the nodes that hear this program
// (NodesThatHear); their addresses are reached, whether they answered the trial or not.
std::vector<Finding> OfMulticast(const GatewayConfig &config, const std::vector<Interface> &used,
                                 const NetworkFacts &facts, const std::set<std::string> &heardBy);
// Names the participants of our domain that are heard and not among the nodes.
std::vector<Finding> OfOtherParticipants(const GatewayConfig &config, const NetworkFacts &facts,
                                         const std::set<std::string> &nodes);
// Finds other domains in use. `anyNode`: a node was heard in ours.
std::vector<Finding> OfDomains(const GatewayConfig &config, const NetworkFacts &facts, bool anyNode);
// If no node was found in any domain: says which domains were only listened to, for so many seconds. In the
// configured domain and in the first `asked` ones the participants were asked to announce themselves.
std::vector<Finding> OfSilentDomains(const GatewayConfig &config, const NetworkFacts &facts, bool anyNode,
                                     int asked, double seconds);
// Finds participants of our domain on interfaces that are not used: they hear nothing that is sent on the
// others. `anyNode`: a node was heard on those that are used.
std::vector<Finding> OfOtherInterfaces(const GatewayConfig &config, const std::vector<Interface> &used,
                                       const NetworkFacts &facts, bool anyNode);
// Finds participants of our domain on this machine that hear no multicast. They are a problem if the loopback
// interface is the only one that is used: then they are meant.
std::vector<Finding> OfLoopback(const GatewayConfig &config, const std::vector<Interface> &used,
                                const NetworkFacts &facts);
// Finds nodes of our domain with keys if this program has none, or hears none with its own, and programs
// without keys if this one has some. `used`: interfaces; this program is heard at their addresses, too.
// `anyNode`: a node was heard.
std::vector<Finding> OfKeys(const GatewayConfig &config, const std::vector<Interface> &used,
                            const NetworkFacts &facts, bool anyNode);

}  // namespace Rabit::Tool::Doctor
