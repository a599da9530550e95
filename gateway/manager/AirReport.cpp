#include "manager/AirReport.h"

#include <rabit/gateway/ClassRates.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "manager/ImportanceOf.h"

namespace Rabit
{
namespace
{

constexpr AirReport::Duration ShortestTime = std::chrono::milliseconds(900);

double &RateOf(TrafficClass traffic, Gateway::AirStatus &air)
{
    return air.*ClassRates.at(static_cast<std::size_t>(traffic)).Value;
}

// The words stay the same while sizes and the estimated capacity differ, so that the log says it once.
void AddTooLarge(const std::string &message, const std::string &limit, const std::string &remedy,
                 Gateway::Fleet &fleet)
{
    fleet.problems.push_back({"publish " + message, "",
                              "one value takes more than a second of " + limit +
                                  ", and newer values wait meanwhile; post smaller ones" + remedy});
}

}  // namespace

void AirReport::Rate::Look(std::uint64_t bytes, double seconds)
{
    PerSecond = bytes > Bytes ? static_cast<double>(bytes - Bytes) / seconds : 0.0;
    Bytes = bytes;
    Seen = true;
}

Gateway::AirStatus AirReport::Fill(const TransportCounters &counters, std::optional<double> capacity,
                                   const std::deque<TopicPublisher> &publishers, const Sent &sent,
                                   const std::function<bool(std::string_view node)> &carries,
                                   Gateway::Fleet &fleet, Duration now)
{
    if (_measuredAt == Duration(0) || now - _measuredAt >= ShortestTime)
    {
        const double seconds = std::chrono::duration<double>(now - _measuredAt).count();
        Measure(counters, publishers, sent, fleet, seconds);
        _measuredAt = now;
    }
    Gateway::AirStatus air;
    air.budget = _config.Radio.Budget.value_or(0.0);
    air.capacity = capacity.value_or(0.0);
    air.discovery = _discovery.PerSecond;
    air.used = _discovery.PerSecond + _samples.PerSecond;
    double divided = 0.0;
    for (std::size_t i = 0; i < fleet.publications.size() && i < _publications.size(); ++i)
    {
        const auto bytes = static_cast<double>(publishers[i].SampleBytes(_cost));
        if (air.budget > 0.0 && bytes > air.budget)
        {
            AddTooLarge(fleet.publications[i].message,
                        "the budget of " + std::to_string(static_cast<long long>(air.budget)) + " B/s",
                        ", or raise `radio: budget`", fleet);
        }
        else if (air.capacity > 0.0 && bytes > air.capacity)
        {
            AddTooLarge(fleet.publications[i].message, "what the channel carries", "", fleet);
        }
        const double rate = _publications[i].Sent.PerSecond;
        fleet.publications[i].bytes_per_s += rate;
        RateOf(ImportanceOf(_config.Publish[i]), air) += rate;
        divided += rate;
    }
    for (Gateway::LinkStatus &link : fleet.links)
    {
        if (!carries(link.node))
        {
            continue;
        }
        const auto known = _links.find({link.node, link.queue});
        link.bytes_per_s = known == _links.end() ? 0.0 : known->second.PerSecond;
        RateOf(ImportanceOf(_config.Send, link.node, link.queue).Class, air) += link.bytes_per_s;
        divided += link.bytes_per_s;
    }
    RateOf(TrafficClass::Foreign, air) += _foreign.PerSecond;
    divided += _foreign.PerSecond;
    air.presence = std::max(0.0, _samples.PerSecond - divided);
    return air;
}

std::string AirReport::TextOf(const Gateway::AirStatus &air)
{
    std::string text = std::to_string(std::llround(air.budget));
    const auto add = [&text](double rate) { text += ' ' + std::to_string(std::llround(rate)); };
    add(air.capacity);
    add(air.used);
    add(air.discovery);
    for (const auto &[name, rate] : ClassRates)
    {
        add(air.*rate);
    }
    return text;
}

void AirReport::Measure(const TransportCounters &counters, const std::deque<TopicPublisher> &publishers,
                        const Sent &sent, const Gateway::Fleet &fleet, double seconds)
{
    _discovery.Look(counters.DiscoveryBytes, seconds);
    _samples.Look(counters.SampleBytes, seconds);
    _foreign.Look(sent.Foreign, seconds);
    _publications.resize(publishers.size());
    for (std::size_t i = 0; i < publishers.size(); ++i)
    {
        Publication &publication = _publications[i];
        const std::uint64_t written = publishers[i].Written();
        const std::size_t each = publishers[i].SampleBytes(_cost);
        const std::uint64_t computed = publication.Sent.Bytes + (written - publication.Written) * each;
        publication.Sent.Look(i < sent.Publications.size() ? sent.Publications[i] : computed, seconds);
        publication.Written = written;
    }
    for (auto &[name, rate] : _links)
    {
        rate.Seen = false;
    }
    for (const Gateway::LinkStatus &link : fleet.links)
    {
        _links[{link.node, link.queue}].Look(link.bytes, seconds);
    }
    std::erase_if(_links, [](const auto &link) { return !link.second.Seen; });
}

}  // namespace Rabit
