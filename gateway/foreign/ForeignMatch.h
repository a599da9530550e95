#pragma once

#include <rabit/gateway/ForeignRule.h>
#include <rabit/transport/Transport.h>

#include <string>
#include <vector>

namespace Rabit::ForeignMatch
{

// `reliable, transient local` and the like.
std::string QosText(Reliability reliability, Durability durability);

// What a reader asks for: what the rule says, and for the rest the most that all programs' writers of the
// type offer, so that it matches them all. While there are none that is `before`.
TopicQos ReaderQos(const ForeignRule &rule, const std::vector<RemoteEndpoint> &endpoints,
                   const TopicQos &before);
// What it asks for at first: volatile, best effort, and reliable for a queue. Were that another one, the
// samples between would be lost when it is made anew.
TopicQos FirstReaderQos(const ForeignRule &rule);
// What a writer offers.
TopicQos WriterQos(const ForeignRule &rule);

// Whether a program's endpoint on the topic matches one of ours with that QoS, in the default partition; what
// keeps it from that, in words, empty if nothing does.
std::string WhyNot(const ForeignRule &rule, const TopicQos &ours, const RemoteEndpoint &theirs);

// Of a topic that is read, the programs' writers that match; of one that is written, their readers.
std::vector<RemoteEndpoint> Matching(const ForeignRule &rule, const TopicQos &ours,
                                     const std::vector<RemoteEndpoint> &endpoints);

// Why no program's endpoint matches, by name; there must be none. `topics` are all that others have endpoints
// on. `isMismatch` becomes whether some are there that do not fit.
std::string WhyNone(const ForeignRule &rule, const TopicQos &ours,
                    const std::vector<RemoteEndpoint> &endpoints, const std::vector<std::string> &topics,
                    int domain, bool &isMismatch);

}  // namespace Rabit::ForeignMatch
