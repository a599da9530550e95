#pragma once

#include <rabit/RabitWorkspace.h>
#include <rabit/gateway/GatewayConfig.h>
#include <rabit/idl/MessageType.h>
#include <rabit/transport/Transport.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "gateway.idl.h"
#include "mirrors/LogThrottle.h"
#include "presence/OriginTable.h"

namespace Rabit
{

// Mirrors one topic to local messages `<node>/<message>`, one for each node that writes it with a given QoS
// profile. Decodes each sample once, on the transport's thread, and posts it there, without a lock held.
//
// What is not posted: samples of a node that has not been heard as live or is in another life by now (a late
// joiner may be handed the past; a State is repeated soon after), what is older than what was posted of that
// life, or of a time in the future, repetitions of a State that is posted already, what does not decode, and
// samples of programs that are not nodes. All but the repetitions are counted as dropped.
//
// That an instance is disposed, or has lost its writer, changes nothing. If it is the former one, the message
// has another value by now, or will have. If it is the present one, there is nothing newer to show: a message
// keeps its last value, and its age and its origin's state tell what that is worth.
class TopicSubscriber
{
public:
    // `origins` and the workspace must outlive the object.
    TopicSubscriber(const SubscribeRule &rule, QosProfile profile, const MessageType &type,
                    const OriginTable &origins, RabitWorkspace &workspace);
    ~TopicSubscriber();

    // Opens the reader; throws TransportError.
    void Open(TransportSession &session);

    QosProfile Profile() const { return _profile; }
    // Samples of that node that were posted, and DDS writers that match now.
    std::uint64_t ReceivedFrom(const std::string &node) const;
    int MatchedWriters() const;
    // The node is forgotten: so are its counters. Its local message stays, as every message does.
    void Forget(const std::string &node);
    // Samples dropped because they came from a node beyond those that are kept.
    std::uint64_t CrowdedOut() const;
    // Counters for each node.
    std::vector<Gateway::TopicStatus> Status() const;
    // Why mirrored messages of that node cannot be posted; empty if they can.
    std::string LocalProblem(const std::string &node) const;

private:
    // One node that writes the topic.
    struct Source
    {
        Gateway::TopicStatus Counters;
        std::shared_ptr<PublishSubscribeMessage> Global;
        std::string Problem;
        std::uint64_t Incarnation = 0;
        std::int64_t LastTime = 0;
        std::uint64_t LastHash = 0;
        bool AnyPosted = false;
        LogThrottle Log;
    };

    void OnSample(SampleBytes bytes, const SampleInfo &info);
    std::shared_ptr<Source> SourceOf(std::string_view node);
    void Register(Source &source);
    static bool IsOvertaken(const Source &source, const SampleInfo &info);
    bool IsRepetition(const Source &source, const SampleInfo &info, std::uint64_t hash) const;
    void CountUndecodable(Source &source, std::size_t size);

    const SubscribeRule _rule;
    const QosProfile _profile;
    const MessageType &_type;
    const OriginTable &_origins;
    RabitWorkspace &_workspace;
    // Only the handler uses it, and a reader's handlers never run two at once.
    std::unique_ptr<RabitMessage> _scratch;

    mutable std::mutex _mutex;  // guards the counters in _sources, and the map
    // The handler holds the one that it uses, which may be forgotten meanwhile.
    std::map<std::string, std::shared_ptr<Source>, std::less<>> _sources;
    std::uint64_t _crowdedOut = 0;

    std::unique_ptr<TransportReader> _reader;
};

}  // namespace Rabit
