#include "configuration/ForeignEntries.h"

#include <rabit/gateway/ConfigError.h>

#include <string>
#include <vector>

#include "configuration/ConfigSections.h"

namespace Rabit
{
namespace
{

// Keys that only one of the two directions has.
const std::vector<std::string> OfSubscribe = {"as", "stale_after", "age"};
const std::vector<std::string> OfPublish = {"topic", "depth", "max_rate"};

void RefuseKeys(const YamlMap &entry, const std::vector<std::string> &keys, const char *direction)
{
    for (const std::string &key : keys)
    {
        if (entry.Has(key))
        {
            entry.Fail(entry.Line(key), "`" + key + "` is not for an entry that " + direction);
        }
    }
}

void ReadQos(const YamlMap &entry, ForeignRule &rule)
{
    const int reliability = entry.ReadChoice("reliability", {"best_effort", "reliable", "as_found"});
    if (reliability == 0 || reliability == 1)
    {
        rule.Reliability = reliability == 1 ? Reliability::Reliable : Reliability::BestEffort;
    }
    const int durability = entry.ReadChoice("durability", {"volatile", "transient_local", "as_found"});
    if (durability == 0 || durability == 1)
    {
        rule.Durability = durability == 1 ? Durability::TransientLocal : Durability::Volatile;
    }
    if (rule.Way == ForeignRule::Direction::Publish && (reliability == 2 || durability == 2))
    {
        entry.Fail(entry.Line(reliability == 2 ? "reliability" : "durability"),
                   "`as_found` is not for an entry that publishes");
    }
}

void ReadSubscribed(const YamlMap &entry, ForeignRule &rule)
{
    RefuseKeys(entry, OfPublish, "subscribes");
    entry.Require("as");
    entry.Read("subscribe", rule.Topic);
    entry.Read("as", rule.Local);
    entry.Read("stale_after", rule.StaleAfter);
    rule.SourceTimeIsTrusted = entry.ReadChoice("age", {"arrival", "source_time"}) == 1;
}

void ReadPublished(const YamlMap &entry, ForeignRule &rule)
{
    rule.Way = ForeignRule::Direction::Publish;
    RefuseKeys(entry, OfSubscribe, "publishes");
    entry.Read("publish", rule.Local);
    rule.Topic = rule.Local;
    entry.Read("topic", rule.Topic);
    if (entry.Has("depth"))
    {
        entry.Read("depth", rule.Depth.emplace(), 1, 10'000);
    }
    entry.Read("max_rate", rule.MaxRate);
}

}  // namespace

void ReadForeign(const YamlMap &map, GatewayConfig &config)
{
    for (const YamlMap &entry : map.Maps("foreign", ConfigSectionAt("foreign")))
    {
        ForeignRule rule;
        rule.Line = entry.Line();
        if (entry.Has("subscribe") == entry.Has("publish"))
        {
            entry.Fail(entry.Line(), "a `foreign` entry has either `subscribe` or `publish`");
        }
        entry.ReadType("type", rule.Type);
        entry.Read("names", {"plain", "ros2"}, rule.Names);
        entry.Read("each", {"latest", "queue"}, rule.Each);
        entry.Read("capacity", rule.Capacity, 1, 1'000'000);
        entry.Read("capacity_bytes", rule.CapacityBytes, 1, std::size_t{1} << 40);
        if (entry.Has("subscribe"))
        {
            ReadSubscribed(entry, rule);
        }
        else
        {
            ReadPublished(entry, rule);
        }
        ReadQos(entry, rule);
        config.Foreign.push_back(std::move(rule));
    }
}

}  // namespace Rabit
