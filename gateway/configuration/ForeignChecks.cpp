#include <rabit/gateway/NamePattern.h>

#include <algorithm>
#include <map>

#include "configuration/ConfigCheck.h"
#include "configuration/ForeignEntries.h"
#include "names/ForeignNames.h"

namespace Rabit
{
namespace
{

constexpr std::size_t LongestTopic = 255;

// The type of a name, and the line of the configuration that gives it.
struct Said
{
    std::string Type;
    int Line = 0;
};
using SaidOf = std::map<std::string, Said>;

class ForeignChecks : ConfigCheck
{
public:
    using ConfigCheck::ConfigCheck;

    void Run()
    {
        if (_config.Tool && !std::all_of(_config.Foreign.begin(), _config.Foreign.end(), IsSubscribed))
        {
            Fail(0, "a tool writes no `foreign` topics");
        }
        for (const PublishRule &rule : _config.Publish)
        {
            _topics[rule.Message] = {rule.Type, rule.Line};
            _messages[rule.Message] = {rule.Type, rule.Line};
        }
        for (const SubscribeRule &rule : _config.Subscribe)
        {
            _topics[rule.Message] = {rule.Type, rule.Line};
        }
        for (const AcceptRule &rule : _config.Accept)
        {
            _managersQueues[rule.Queue] = rule.Line;
        }
        for (const ForeignRule &rule : _config.Foreign)
        {
            if (IsSubscribed(rule) && rule.Each == ForeignRule::Delivery::Queue)
            {
                _managersQueues[rule.Local] = rule.Line;
            }
        }
        for (const ForeignRule &rule : _config.Foreign)
        {
            Check(rule);
        }
        for (const ForeignRule &rule : _config.Foreign)
        {
            CheckNoEcho(rule);
        }
    }

private:
    static bool IsSubscribed(const ForeignRule &rule)
    {
        return rule.Way == ForeignRule::Direction::Subscribe;
    }

    void Check(const ForeignRule &rule)
    {
        const std::string topic = WireTopicOf(rule);
        const bool isPrintable =
            std::all_of(topic.begin(), topic.end(), [](char c) { return c > ' ' && c <= '~'; });
        if (rule.Topic.empty() || topic.size() > LongestTopic || !isPrintable)
        {
            Fail(rule.Line,
                 "`" + rule.Topic + "` is no topic name; expected 1 to 255 letters without blanks");
        }
        if (topic.find_first_of("*?") != std::string::npos)
        {
            Fail(rule.Line, "`" + rule.Topic +
                                "` is taken literally, as the name of one topic; expected a name without "
                                "wildcards, and an entry for each topic");
        }
        if (const std::string why = WhyNoRosTopic(rule.Topic);
            rule.Names == ForeignRule::WireNames::Ros2 && !why.empty())
        {
            Fail(rule.Line, "`" + rule.Topic + "` is no topic name of ROS 2: it " + why);
        }
        if (topic.rfind("rabit/", 0) == 0)
        {
            Fail(rule.Line, "`" + topic + "` is a topic of the gateways themselves");
        }
        CheckType(rule.Type, rule.Line);
        if (!IsMessageName(rule.Local))
        {
            Fail(rule.Line,
                 "`" + rule.Local +
                     "` is no name of a message or queue; expected 1 to 200 of A-Z a-z 0-9 _ . - : /");
        }
        CheckRanges(rule);
        CheckOneType(_topics, topic, WireTypeOf(rule), "the topic", rule.Line);
        CheckLocal(rule);
        CheckOnce(IsSubscribed(rule) ? _subscribed : _published, topic, "foreign", rule.Line);
    }

    void CheckRanges(const ForeignRule &rule) const
    {
        if (rule.StaleAfter < std::chrono::milliseconds(0) || rule.StaleAfter > std::chrono::hours(24))
        {
            Fail(rule.Line, "`stale_after` is out of range; expected 0s (never) to a day");
        }
        CheckMaxRate(rule.MaxRate, rule.Line);
        CheckRange(rule.Depth.value_or(1), 10'000, "depth", rule.Line);
        CheckRange(rule.Capacity, 1'000'000, "capacity", rule.Line);
        CheckRange(rule.CapacityBytes, std::size_t{1} << 40, "capacity_bytes", rule.Line);
    }

    void CheckLocal(const ForeignRule &rule)
    {
        if (rule.Each == ForeignRule::Delivery::Queue)
        {
            // A queue that is read into takes messages of any type, from anybody.
            if (!IsSubscribed(rule))
            {
                CheckWrittenQueue(rule);
            }
            return;
        }
        CheckOneType(_messages, rule.Local, rule.Type, "the message", rule.Line);
        if (IsSubscribed(rule))
        {
            CheckOnce(_posted, rule.Local, "foreign", rule.Line);
            if (rule.Local.rfind(_config.Name + "/", 0) == 0)
            {
                Fail(rule.Line, "`" + rule.Local + "` belongs to the gateway; expected another name");
            }
            CheckNoMirror(rule);
        }
    }

    // A message that comes from another node has one source. The pattern `*` names no node: a program may
    // stand beside the nodes under a name of its own.
    void CheckNoMirror(const ForeignRule &rule) const
    {
        const std::size_t slash = rule.Local.find('/');
        if (slash == std::string::npos)
        {
            return;
        }
        const std::string node = rule.Local.substr(0, slash);
        const std::string message = rule.Local.substr(slash + 1);
        for (const SubscribeRule &mirror : _config.Subscribe)
        {
            const auto names = [&node](const std::string &pattern)
            { return pattern != "*" && MatchesPattern(pattern, node); };
            if (mirror.Message == message && std::any_of(mirror.From.begin(), mirror.From.end(), names))
            {
                Fail(rule.Line, "`" + rule.Local + "` is the message of the node `" + node +
                                    "` that `subscribe` brings" +
                                    (mirror.Line > 0 ? " in line " + std::to_string(mirror.Line) : "") +
                                    "; expected another name");
            }
        }
    }

    // A message goes into a manager's queue, or to one topic.
    void CheckWrittenQueue(const ForeignRule &rule)
    {
        if (const auto queue = _managersQueues.find(rule.Local); queue != _managersQueues.end())
        {
            Fail(rule.Line, "the queue `" + rule.Local + "` is a manager's" +
                                (queue->second > 0 ? " by line " + std::to_string(queue->second) : "") +
                                "; expected a name that no manager's queue has");
        }
        CheckOnce(_writtenQueues, rule.Local, "foreign", rule.Line);
    }

    void CheckOneType(SaidOf &known, const std::string &name, const std::string &type, const char *what,
                      int line) const
    {
        const auto [place, isNew] = known.emplace(name, Said{type, line});
        if (!isNew && place->second.Type != type)
        {
            Fail(line, std::string(what) + " `" + name + "` is of type `" + type + "` here and `" +
                           place->second.Type + "` " +
                           (place->second.Line > 0 ? "in line " + std::to_string(place->second.Line)
                                                   : "elsewhere"));
        }
    }

    // Fails if `written` would write a message back to the topic from which another rule reads it.
    void CheckNoEcho(const ForeignRule &written) const
    {
        for (const ForeignRule &read : _config.Foreign)
        {
            if (!IsSubscribed(written) && IsSubscribed(read) && read.Local == written.Local &&
                WireTopicOf(read) == WireTopicOf(written))
            {
                Fail(written.Line,
                     "`" + written.Local + "` would be written back to the topic that it comes from");
            }
        }
    }

    SaidOf _topics;
    SaidOf _messages;
    std::map<std::string, int> _subscribed;
    std::map<std::string, int> _published;
    std::map<std::string, int> _posted;
    std::map<std::string, int> _managersQueues;
    std::map<std::string, int> _writtenQueues;
};

}  // namespace

void CheckForeign(const GatewayConfig &config, const TypeCheck &whyNoType)
{
    ForeignChecks(config, whyNoType).Run();
}

}  // namespace Rabit
