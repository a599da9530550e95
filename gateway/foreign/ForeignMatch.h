#pragma once

#include <rabit/gateway/ForeignRule.h>
#include <rabit/transport/Transport.h>

#include <string>
#include <vector>

namespace Rabit::ForeignMatch
{

// `reliable, transient local` and the like.
std::string QosText(Reliability reliability, Durability durability);

// The QoS that a reader asks for. Settings of the rule hold. For the rest it asks for the most that all
// programs' writers of the type offer, so that it matches them all; while there are none, for `before`.
TopicQos ReaderQos(const ForeignRule &rule, const std::vector<RemoteEndpoint> &endpoints,
                   const TopicQos &before);
// The first QoS of a reader: volatile, and best effort, or reliable for a queue. If the writers offer another
// QoS, the reader is made anew, and the samples in between are lost.
TopicQos FirstReaderQos(const ForeignRule &rule);
// The QoS that a writer offers.
TopicQos WriterQos(const ForeignRule &rule);

// Returns, in words, why a program's endpoint on the topic does not match one of ours with that QoS, in the
// default partition. Empty: it matches.
std::string WhyNot(const ForeignRule &rule, const TopicQos &ours, const RemoteEndpoint &theirs);

// Returns the programs' writers that match, if the rule reads the topic; their readers, if it writes it.
std::vector<RemoteEndpoint> Matching(const ForeignRule &rule, const TopicQos &ours,
                                     const std::vector<RemoteEndpoint> &endpoints);

// Returns, in words, how a program falls short although at least one matches: it has another type or QoS, or
// it makes a queue of reliable writers best effort. Partitions are no reason: who is in another one is meant
// for others. Empty: no program falls short.
std::string Shortfall(const ForeignRule &rule, const TopicQos &ours,
                      const std::vector<RemoteEndpoint> &endpoints);

// Where this node listens.
struct Network
{
    int Domain = 0;
    std::vector<std::string> Interfaces{};  // empty: all
    std::string Path{};                     // of several, the one that foreign topics use
    std::vector<std::string> Own{};         // topics that this node uses itself, which no hint names
};

// Returns, by name, why no program's endpoint matches. Precondition: none does. `topics` are all topics on
// which others have endpoints. Sets `isMismatch`: true if programs have endpoints on the topic that do not
// fit.
std::string WhyNone(const ForeignRule &rule, const TopicQos &ours,
                    const std::vector<RemoteEndpoint> &endpoints, const std::vector<std::string> &topics,
                    const Network &network, bool &isMismatch);

}  // namespace Rabit::ForeignMatch
