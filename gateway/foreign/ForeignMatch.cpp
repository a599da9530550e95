#include "foreign/ForeignMatch.h"

#include <rabit/idl/NearestWord.h>

#include <algorithm>

#include "names/ForeignNames.h"
#include "names/ListedNames.h"
#include "names/NamePattern.h"

namespace Rabit::ForeignMatch
{
namespace
{

bool IsRead(const ForeignRule &rule)
{
    return rule.Way == ForeignRule::Direction::Subscribe;
}

// True for a program's endpoint at the other end of the rule's topic.
bool IsOpposite(const ForeignRule &rule, const RemoteEndpoint &endpoint)
{
    return endpoint.IsWriter == IsRead(rule) && endpoint.Node.empty();
}

bool IsInDefaultPartition(const RemoteEndpoint &endpoint)
{
    return endpoint.Partitions.empty() || MatchesAny(endpoint.Partitions, "");
}

const char *TextOf(Reliability reliability)
{
    return reliability == Reliability::Reliable ? "reliable" : "best effort";
}

const char *TextOf(Durability durability)
{
    return durability == Durability::TransientLocal ? "transient local" : "volatile";
}

}  // namespace

std::string QosText(Reliability reliability, Durability durability)
{
    return std::string(TextOf(reliability)) + ", " + TextOf(durability);
}

TopicQos ReaderQos(const ForeignRule &rule, const std::vector<RemoteEndpoint> &endpoints,
                   const TopicQos &before)
{
    bool any = false;
    bool reliable = true;
    bool transientLocal = true;
    for (const RemoteEndpoint &endpoint : endpoints)
    {
        if (IsOpposite(rule, endpoint) && endpoint.Type == WireTypeOf(rule) && IsInDefaultPartition(endpoint))
        {
            any = true;
            reliable = reliable && endpoint.Reliability == Reliability::Reliable;
            transientLocal = transientLocal && endpoint.Durability == Durability::TransientLocal;
        }
    }
    TopicQos qos = before;
    if (any)
    {
        qos.Reliability = reliable ? Reliability::Reliable : Reliability::BestEffort;
    }
    qos.Reliability = rule.Reliability.value_or(qos.Reliability);
    if (any)
    {
        // Only a reliable reader gets history.
        qos.Durability = transientLocal && qos.Reliability == Reliability::Reliable
                             ? Durability::TransientLocal
                             : Durability::Volatile;
    }
    qos.Durability = rule.Durability.value_or(qos.Durability);
    return qos;
}

TopicQos FirstReaderQos(const ForeignRule &rule)
{
    const bool isQueue = rule.Each == ForeignRule::Delivery::Queue;
    const TopicQos guess{isQueue ? Reliability::Reliable : Reliability::BestEffort, Durability::Volatile, 1};
    return ReaderQos(rule, {}, guess);
}

TopicQos WriterQos(const ForeignRule &rule)
{
    TopicQos qos;
    qos.Reliability = rule.Reliability.value_or(Reliability::Reliable);
    qos.Durability = rule.Durability.value_or(Durability::Volatile);
    const std::size_t byDefault =
        rule.Each == ForeignRule::Delivery::Queue ? ForeignRule::DepthOfQueue : ForeignRule::DepthOfMessage;
    qos.Depth = static_cast<int>(rule.Depth.value_or(byDefault));
    return qos;
}

std::string WhyNot(const ForeignRule &rule, const TopicQos &ours, const RemoteEndpoint &theirs)
{
    const std::string topic = std::string("`").append(WireTopicOf(rule)).append("`");
    const char *does = IsRead(rule) ? "writes " : "reads ";
    if (theirs.Type != WireTypeOf(rule))
    {
        return std::string("a program ") + does + topic + " as `" + theirs.Type + "`, this node " +
               (IsRead(rule) ? "reads " : "writes ") + "it as `" + WireTypeOf(rule) + "`";
    }
    if (!IsInDefaultPartition(theirs))
    {
        return std::string("a program ") + does + topic + " in the partition " +
               ListedNames(theirs.Partitions) + ", this node in the default one";
    }
    const TopicQos there{theirs.Reliability, theirs.Durability, 1};
    const TopicQos &offered = IsRead(rule) ? there : ours;
    const TopicQos &asked = IsRead(rule) ? ours : there;
    const char *asks = IsRead(rule) ? "this node asks for " : "asks for ";
    const char *offers = IsRead(rule) ? "is " : "this node offers ";
    const std::string who = std::string("a program that ") + does + topic + " ";
    const auto differs = [&](const char *offer, const char *wish)
    {
        return IsRead(rule) ? who + offers + offer + ", " + asks + wish
                            : who + asks + wish + ", " + offers + offer;
    };
    if (asked.Reliability == Reliability::Reliable && offered.Reliability == Reliability::BestEffort)
    {
        return differs(TextOf(offered.Reliability), TextOf(asked.Reliability));
    }
    if (asked.Durability == Durability::TransientLocal && offered.Durability == Durability::Volatile)
    {
        return differs(TextOf(offered.Durability), TextOf(asked.Durability));
    }
    if (theirs.IsExclusive)
    {
        return IsRead(rule) ? differs("of exclusive ownership", "shared ownership")
                            : differs("shared ownership", "exclusive ownership");
    }
    if (!IsRead(rule) && theirs.HasDeadline)
    {
        return differs("none", "a deadline");
    }
    if (!IsRead(rule) && theirs.HasLiveliness)
    {
        return differs("none", "a liveliness with a lease or by hand");
    }
    return "";
}

std::vector<RemoteEndpoint> Matching(const ForeignRule &rule, const TopicQos &ours,
                                     const std::vector<RemoteEndpoint> &endpoints)
{
    std::vector<RemoteEndpoint> matching;
    std::copy_if(endpoints.begin(), endpoints.end(), std::back_inserter(matching),
                 [&](const RemoteEndpoint &endpoint)
                 { return IsOpposite(rule, endpoint) && WhyNot(rule, ours, endpoint).empty(); });
    return matching;
}

std::string Shortfall(const ForeignRule &rule, const TopicQos &ours,
                      const std::vector<RemoteEndpoint> &endpoints)
{
    bool anyReliable = false;
    bool anyBestEffort = false;
    for (const RemoteEndpoint &endpoint : endpoints)
    {
        if (!IsOpposite(rule, endpoint) || !IsInDefaultPartition(endpoint))
        {
            continue;
        }
        if (std::string why = WhyNot(rule, ours, endpoint); !why.empty())
        {
            return why;
        }
        const bool isReliable = endpoint.Reliability == Reliability::Reliable;
        anyReliable = anyReliable || isReliable;
        anyBestEffort = anyBestEffort || !isReliable;
    }
    const bool isAsFound = IsRead(rule) && !rule.Reliability;
    return isAsFound && rule.Each == ForeignRule::Delivery::Queue && anyReliable && anyBestEffort
               ? "a program that writes `" + WireTopicOf(rule) +
                     "` is best effort, so this node reads the reliable ones without repair, too: samples "
                     "may "
                     "be lost; give the entry a `reliability`"
               : "";
}

std::string WhyNone(const ForeignRule &rule, const TopicQos &ours,
                    const std::vector<RemoteEndpoint> &endpoints, const std::vector<std::string> &topics,
                    const Network &network, bool &isMismatch)
{
    isMismatch = false;
    bool nodes = false;
    for (const RemoteEndpoint &endpoint : endpoints)
    {
        if (IsOpposite(rule, endpoint))
        {
            isMismatch = true;
            return WhyNot(rule, ours, endpoint);
        }
        nodes = nodes || endpoint.IsWriter == IsRead(rule);
    }
    const std::string does = IsRead(rule) ? "writes `" : "reads `";
    const std::string where = WireTopicOf(rule) + "` in domain " + std::to_string(network.Domain);
    if (nodes)
    {
        return "only nodes of Rabit, and no program, " + std::string(IsRead(rule) ? "write `" : "read `") +
               where;
    }
    std::vector<std::string> candidates;
    std::copy_if(topics.begin(), topics.end(), std::back_inserter(candidates),
                 [&](const std::string &topic)
                 {
                     const auto &own = network.Own;
                     return topic.rfind("rabit/", 0) != 0 && topic != WireTopicOf(rule) &&
                            std::find(own.begin(), own.end(), topic) == own.end();
                 });
    const std::string hint = NearestWordHint(WireTopicOf(rule), candidates);
    // If this node writes the topic, only a misspelled name is worth a hint: a reader may still come.
    const bool isSlip = hint.rfind("; did you mean", 0) == 0;
    const std::string beside = IsRead(rule) || isSlip ? hint : "";
    if (!beside.empty() || network.Interfaces.empty())
    {
        return "no program " + does + where + beside;
    }
    const std::string path = network.Path.empty() ? "" : ", those of path `" + network.Path + "`,";
    return "no program " + does + where + "; a program that listens on other interfaces than " +
           ListedNames(network.Interfaces) + path + " cannot be reached";
}

}  // namespace Rabit::ForeignMatch
