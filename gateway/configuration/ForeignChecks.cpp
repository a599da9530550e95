#include <rabit/gateway/ConfigError.h>

#include <algorithm>
#include <map>

#include "configuration/ForeignEntries.h"
#include "names/ForeignNames.h"
#include "names/NamePattern.h"

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

class ForeignChecks
{
public:
    ForeignChecks(const GatewayConfig &config, const TypeCheck &whyNoType)
        : _config(config), _whyNoType(whyNoType)
    {
    }

    void Run()
    {
        if (_config.Tool && !_config.Foreign.empty())
        {
            Fail(0, "a tool has no `foreign` topics");
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
    [[noreturn]] void Fail(int line, const std::string &message) const
    {
        throw ConfigError(_config.File, line, message);
    }

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
        if (topic.rfind("rabit/", 0) == 0)
        {
            Fail(rule.Line, "`" + topic + "` is a topic of the gateways themselves");
        }
        const std::string whyNoType = _whyNoType(rule.Type);
        if (!whyNoType.empty())
        {
            Fail(rule.Line, whyNoType);
        }
        if (!IsMessageName(rule.Local))
        {
            Fail(rule.Line,
                 "`" + rule.Local +
                     "` is no name of a message or queue; expected 1 to 200 of A-Z a-z 0-9 _ . - : /");
        }
        CheckRanges(rule);
        CheckOneType(_topics, topic, WireTypeOf(rule), "the topic", rule.Line);
        CheckLocal(rule);
        CheckOnce(IsSubscribed(rule) ? _subscribed : _published, topic, rule.Line);
    }

    void CheckRanges(const ForeignRule &rule) const
    {
        if (rule.StaleAfter < std::chrono::milliseconds(0) || rule.StaleAfter > std::chrono::hours(24))
        {
            Fail(rule.Line, "`stale_after` is out of range; expected 0s (never) to a day");
        }
        if (!(rule.MaxRate >= 0.0 && rule.MaxRate <= 1e6))
        {
            Fail(rule.Line, "max_rate is out of range; expected 0 (no limit) to 1000000 a second");
        }
        if (rule.Depth < 1 || rule.Depth > 10'000)
        {
            Fail(rule.Line, "`depth` is out of range; expected 1 to 10000");
        }
        if (rule.Capacity < 1 || rule.Capacity > 1'000'000)
        {
            Fail(rule.Line, "`capacity` is out of range; expected 1 to 1000000");
        }
        if (rule.CapacityBytes < 1 || rule.CapacityBytes > std::size_t{1} << 40)
        {
            Fail(rule.Line, "`capacity_bytes` is out of range; expected 1 to 1099511627776");
        }
    }

    void CheckLocal(const ForeignRule &rule)
    {
        if (rule.Each == ForeignRule::Delivery::Queue)
        {
            return;  // a queue takes messages of any type, from anybody
        }
        CheckOneType(_messages, rule.Local, rule.Type, "the message", rule.Line);
        if (IsSubscribed(rule))
        {
            CheckOnce(_posted, rule.Local, rule.Line);
            if (rule.Local.rfind(_config.Name + "/", 0) == 0)
            {
                Fail(rule.Line, "`" + rule.Local + "` belongs to the gateway; expected another name");
            }
        }
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

    void CheckOnce(std::map<std::string, int> &seen, const std::string &name, int line) const
    {
        const auto [place, isNew] = seen.emplace(name, line);
        if (!isNew)
        {
            Fail(line,
                 "`" + name + "` stands twice under `foreign`" +
                     (place->second > 0 ? " (first in line " + std::to_string(place->second) + ")" : ""));
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

    const GatewayConfig &_config;
    const TypeCheck &_whyNoType;
    SaidOf _topics;
    SaidOf _messages;
    std::map<std::string, int> _subscribed;
    std::map<std::string, int> _published;
    std::map<std::string, int> _posted;
};

}  // namespace

void CheckForeign(const GatewayConfig &config, const TypeCheck &whyNoType)
{
    ForeignChecks(config, whyNoType).Run();
}

}  // namespace Rabit
