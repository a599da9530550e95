#include <rabit/gateway/NamePattern.h>

#include <algorithm>
#include <map>

#include "air/AirSchedule.h"
#include "configuration/ConfigCheck.h"

namespace Rabit
{
namespace
{

// Prefix of the gateways' own topics.
constexpr const char *OwnTopics = "rabit/";

class MessageChecks : ConfigCheck
{
public:
    using ConfigCheck::ConfigCheck;

    void Run() const
    {
        CheckPublish();
        CheckSubscribe();
        CheckTopicTypes();
        CheckAccept();
        CheckSend();
    }

private:
    void CheckPublish() const
    {
        std::map<std::string, int> seen;
        for (const PublishRule &rule : _config.Publish)
        {
            CheckName(rule.Message, "message", rule.Line);
            if (rule.Message.find('/') != std::string::npos)
            {
                Fail(rule.Line,
                     "`" + rule.Message +
                         "` belongs to another node or to the gateway; expected a name without `/`");
            }
            CheckOnce(seen, rule.Message, "publish", rule.Line);
            CheckType(rule.Type, rule.Line);
            CheckMaxRate(rule.MaxRate, rule.Line);
            CheckImportance(rule.Class.value_or(TrafficClass::State), rule.Weight, rule.Line);
        }
    }

    void CheckSubscribe() const
    {
        std::map<std::string, int> seen;
        for (const SubscribeRule &rule : _config.Subscribe)
        {
            CheckName(rule.Message, "message", rule.Line);
            CheckOnce(seen, rule.Message, "subscribe", rule.Line);
            CheckType(rule.Type, rule.Line);
            CheckPatterns(rule.From, "from", rule.Line);
            if (rule.Message.rfind(OwnTopics, 0) == 0)
            {
                Fail(rule.Line, "`" + rule.Message + "` is a topic of the gateways themselves");
            }
        }
    }

    // A DDS topic has one type. A local message and the message of that name from other nodes are different
    // messages here, but share one topic.
    void CheckTopicTypes() const
    {
        for (const SubscribeRule &wanted : _config.Subscribe)
        {
            const auto offered =
                std::find_if(_config.Publish.begin(), _config.Publish.end(),
                             [&wanted](const PublishRule &rule) { return rule.Message == wanted.Message; });
            if (offered != _config.Publish.end() && offered->Type != wanted.Type)
            {
                Fail(wanted.Line, "`" + wanted.Message + "` is subscribed as `" + wanted.Type +
                                      "` and published as `" + offered->Type + "`" +
                                      (offered->Line > 0 ? " in line " + std::to_string(offered->Line) : "") +
                                      "; a message has one type");
            }
        }
    }

    void CheckAccept() const
    {
        std::map<std::string, int> seen;
        for (const AcceptRule &rule : _config.Accept)
        {
            CheckName(rule.Queue, "queue", rule.Line);
            CheckOnce(seen, rule.Queue, "accept", rule.Line);
            if (rule.Types.empty())
            {
                Fail(rule.Line, "queue `" + rule.Queue + "` accepts no types; expected a list of IDL types");
            }
            std::map<std::string, int> types;
            for (const std::string &type : rule.Types)
            {
                CheckType(type, rule.Line);
                CheckOnce(types, type, "types", rule.Line);
            }
            CheckPatterns(rule.From, "from", rule.Line);
        }
    }

    void CheckSend() const
    {
        std::map<std::string, int> seen;
        for (const SendRule &rule : _config.Send)
        {
            CheckPattern(rule.To, "to", rule.Line);
            if (!IsMessageName(WithoutWildcards(rule.Queue)))
            {
                CheckName(rule.Queue, "queue", rule.Line);
            }
            CheckOnce(seen, rule.To + "/" + rule.Queue, "send", rule.Line);
            CheckReached(rule);
            CheckRange(rule.Capacity, 1'000'000, "capacity", rule.Line);
            CheckRange(rule.CapacityBytes, std::size_t{1} << 40, "capacity_bytes", rule.Line);
            CheckRange(rule.Window, 256, "window", rule.Line);
            CheckImportance(rule.Class, rule.Weight, rule.Line);
            if (rule.Expire < std::chrono::milliseconds(0) || rule.Expire > std::chrono::hours(24 * 365))
            {
                Fail(rule.Line, "`expire` is out of range; expected 0 (never) to a year");
            }
        }
    }

    // Fails if an earlier rule fits all links of this one: the first rule that fits a link holds, so this
    // one would do nothing.
    void CheckReached(const SendRule &rule) const
    {
        for (const SendRule &before : _config.Send)
        {
            if (&before == &rule)
            {
                return;
            }
            if (CoversPattern(before.To, rule.To) && CoversPattern(before.Queue, rule.Queue))
            {
                Fail(rule.Line, "this `send` entry is never used: `" + before.To + "/" + before.Queue + "`" +
                                    (before.Line > 0 ? " in line " + std::to_string(before.Line) : "") +
                                    " fits all that `" + rule.To + "/" + rule.Queue +
                                    "` fits, and the first that fits holds");
            }
        }
    }

    void CheckName(const std::string &name, const char *what, int line) const
    {
        if (!IsMessageName(name))
        {
            Fail(line, "`" + name + "` is no " + what + " name; expected 1 to 200 of A-Z a-z 0-9 _ . - : /");
        }
    }

    void CheckImportance(TrafficClass traffic, double weight, int line) const
    {
        if (!MayBeChosen(traffic))
        {
            Fail(line, std::string("the class ") + TrafficClasses.at(static_cast<std::size_t>(traffic)).Name +
                           " is the gateway's own; expected another one");
        }
        if (!(weight >= AirSchedule::SmallestWeight && weight <= AirSchedule::LargestWeight))
        {
            Fail(line, "`weight` is out of range; expected 0.01 to 100");
        }
    }
};

}  // namespace

void CheckMessages(const GatewayConfig &config, const TypeCheck &whyNoType)
{
    MessageChecks(config, whyNoType).Run();
}

}  // namespace Rabit
