#pragma once

#include <rabit/RabitHandlerThread.h>
#include <rabit/RabitMessageLease.h>
#include <rabit/RabitWorkspace.h>
#include <rabit/gateway/GatewayConfig.h>
#include <rabit/gateway/GatewayTap.h>
#include <rabit/idl/MessageType.h>
#include <rabit/transport/Transport.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "gateway.idl.h"
#include "mirrors/LogThrottle.h"
#include "presence/OriginTable.h"

namespace Rabit
{

// Mirrors one topic to local messages `<node>/<message>`, one for each node that writes it. Decodes each
// sample once, on the transport's thread, and posts it there, without a lock held. The program's own handlers
// of the message are called by `handlers`, so that a slow one does not hold up that thread. The reader is
// best effort and volatile whatever the node announces: a lost State is requested (StateRepair).
//
// Some samples are not posted. Dropped and counted are samples of a node that the rule does not name,
// whatever its partition; that has not been heard as live, or is in another incarnation by now; that
// announces another definition of the type, whose samples may decode as something else; or that does
// not announce the profile of the rule. So are samples that are older than the last one posted of that
// incarnation, lie in the future, or do not decode. Samples of programs that are no nodes are dropped and
// counted, too. Repetitions of a State that is posted already are ignored, and not counted.
//
// That an instance is disposed, or has lost its writer, changes nothing. If it is the former one, the message
// has another value by now, or will have. If it is the present one, there is nothing newer to show: a message
// keeps its last value, and its age and its origin's state tell what that is worth.
class TopicSubscriber
{
public:
    // `origins`, the workspace and `handlers` must outlive the object. Without `handlers` all handlers are
    // called on the transport's thread. The tap, if there is one, is told of each posted sample.
    TopicSubscriber(const SubscribeRule &rule, const MessageType &type, const OriginTable &origins,
                    RabitWorkspace &workspace, RabitHandlerThread *handlers = nullptr,
                    std::shared_ptr<GatewayTap> tap = nullptr);
    ~TopicSubscriber();

    // Open will be called for several sessions. Before the first.
    void ExpectSeveral() { _comesTwice = true; }
    // Reads from that session as well; throws TransportError.
    void Open(TransportSession &session);

    // The profile with which a node announces the message; empty: it does not say, or not yet. A rule with
    // the profile State takes nothing from a node that does not announce State. `isOtherVersion`: it
    // announces the message with another definition of the type.
    void SetOffer(const std::string &node, std::optional<QosProfile> profile, bool isOtherVersion = false);
    // The source time of the newest accepted sample of that incarnation of a node: posted, or useless here
    // however often it comes.
    std::optional<std::int64_t> TakenIn(const std::string &node, std::uint64_t incarnation) const;
    // The incarnation of that node whose sample was posted last; empty: none was.
    std::optional<std::uint64_t> PostedOf(const std::string &node) const;
    // DDS writers that match now.
    int MatchedWriters() const;
    // The node is forgotten: so are its counters and its offer. Its local message leaves the workspace,
    // unless somebody has registered it besides.
    void Forget(const std::string &node);
    // Samples dropped because they came from a node beyond those that are kept.
    std::uint64_t CrowdedOut() const;
    // Counters for each node.
    std::vector<Gateway::TopicStatus> Status() const;
    // Why mirrored messages of that node cannot be posted; empty if they can.
    std::string LocalProblem(const std::string &node) const;

private:
    struct Sample
    {
        std::uint64_t Incarnation = 0;
        std::int64_t Time = 0;
    };

    // One node that writes the topic.
    struct Source
    {
        Gateway::TopicStatus Counters;
        bool IsWanted = false;                    // the rule names it
        std::atomic<bool> IsOtherVersion{false};  // of the type, as it announces
        std::string LocalName;
        std::optional<RabitMessageLease> Local;
        // Exchanged for the local message's contents by each post: of each node its own, so that a large
        // message takes no memory for the others.
        std::unique_ptr<RabitMessage> Scratch;
        std::string Problem;
        std::optional<Sample> Posted;
        std::optional<Sample> Taken;            // guarded, as the counters are
        std::optional<std::uint64_t> PostedOf;  // incarnation of the newest posted sample; likewise
        std::optional<QosProfile> Offer;        // likewise
        LogThrottle Log;
    };

    // The fate of a sample.
    enum class Outcome
    {
        Posted,
        Repeated,
        Undecodable,
        Refused,
        NotPostable  // the local message is of another type
    };

    void OnSample(SampleBytes bytes, const SampleInfo &info);
    Outcome Take(Source &source, std::optional<QosProfile> offer, SampleBytes bytes, const SampleInfo &info);
    void Count(Source &source, Outcome outcome, const SampleInfo &info);
    // Null if there is no room for it. `offer` becomes what it announces.
    std::shared_ptr<Source> SourceOf(std::string_view node, std::optional<QosProfile> &offer);
    void Register(Source &source);
    static bool IsOvertaken(const Source &source, const SampleInfo &info);
    static bool IsRepetition(const Source &source, const SampleInfo &info);
    void LogUndecodable(Source &source, std::size_t size);

    const SubscribeRule _rule;
    const MessageType &_type;
    const OriginTable &_origins;
    RabitWorkspace &_workspace;
    RabitHandlerThread *const _handlers;
    const std::shared_ptr<GatewayTap> _tap;
    // Held by the handler, from decoding to the post, if there are several sessions: their readers may run at
    // once, one reader's handlers never do.
    std::mutex _taking;

    mutable std::mutex _mutex;  // guards the counters in _sources, and the maps
    // The handler holds the one that it uses, which may be forgotten meanwhile.
    std::map<std::string, std::shared_ptr<Source>, std::less<>> _sources;
    std::map<std::string, QosProfile, std::less<>> _offers;
    std::set<std::string, std::less<>> _otherVersions;  // nodes that announce another definition of the type
    std::uint64_t _crowdedOut = 0;

    std::vector<std::unique_ptr<TransportReader>> _readers;
    bool _comesTwice = false;  // there are several sessions
};

}  // namespace Rabit
