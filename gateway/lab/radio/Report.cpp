#include "Report.h"

#include <nlohmann/json.hpp>

#include <chrono>

namespace Rabit::Radio
{
namespace
{

using nlohmann::json;

json AsJson(const Count &count)
{
    return {{"frames", count.Frames}, {"bytes", count.Bytes}};
}

double Seconds(Time time)
{
    return std::chrono::duration<double>(time).count();
}

json NodeAsJson(const Medium &medium, Time now, std::size_t node)
{
    const NodeCounters &counters = medium.CountersOf(node);
    return {{"offered", AsJson(counters.Offered)},
            {"dropped", AsJson(counters.Dropped)},
            {"multicast", AsJson(counters.Multicast)},
            {"unicast", AsJson(counters.Unicast)},
            {"heard", AsJson(counters.Heard)},
            {"ip_bytes", counters.IpSent},
            {"lost", counters.Lost},
            {"missed", counters.Missed},
            {"collided", counters.Collided},
            {"nobody", counters.Nobody},
            {"most_in_a_second", counters.AirSecond.Most()},
            {"most_ip_in_a_second", counters.IpSecond.Most()},
            {"queued", medium.QueuedBytes(node)},
            {"wait_ms", 1000 * Seconds(medium.QueueAge(now, node))},
            {"longest_wait_ms", 1000 * Seconds(counters.LongestWait)}};
}

}  // namespace

std::string CountersAsJson(const Medium &medium, Time now)
{
    json nodes = json::object();
    Count sent;
    std::uint64_t ip = 0;
    for (std::size_t node = 0; node < medium.Count(); ++node)
    {
        nodes[medium.NameOf(node)] = NodeAsJson(medium, now, node);
        const NodeCounters &counters = medium.CountersOf(node);
        sent.Frames += counters.Multicast.Frames + counters.Unicast.Frames;
        sent.Bytes += counters.Multicast.Bytes + counters.Unicast.Bytes;
        ip += counters.IpSent;
    }
    const double seconds = Seconds(now - medium.CountedSince());
    const double busy = Seconds(medium.Busy(now));
    json all{{"seconds", seconds},
             {"bits_per_s", nullptr},
             {"busy_s", busy},
             {"utilisation", seconds > 0 ? busy / seconds : 0.0},
             {"out", medium.IsOut()},
             {"sent", {{"frames", sent.Frames}, {"bytes", sent.Bytes}, {"ip_bytes", ip}}},
             {"nodes", std::move(nodes)}};
    if (medium.Rate())
    {
        all["bits_per_s"] = *medium.Rate();
    }
    return all.dump();
}

std::string KindsAsJson(const Medium &medium)
{
    json all = json::object();
    for (std::size_t node = 0; node < medium.Count(); ++node)
    {
        json kinds = json::object();
        for (const auto &[kind, count] : medium.CountersOf(node).Kinds)
        {
            kinds[NameOf(kind)] = {count.Frames, count.Bytes};
        }
        all[medium.NameOf(node)] = std::move(kinds);
    }
    return all.dump();
}

}  // namespace Rabit::Radio
