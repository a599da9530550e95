#include "RecordedFacts.h"

#include <algorithm>
#include <cstdint>

namespace Rabit::WhatIf
{
namespace
{

using Json = nlohmann::ordered_json;

std::int64_t Since(const Recording &recording, Time time)
{
    return static_cast<std::int64_t>(time - recording.Begin());
}

}  // namespace

std::vector<Json> FactsOfFlight(const Recording &recording)
{
    std::vector<Json> facts;
    facts.push_back({{"fact", "flight"}, {"end", Since(recording, recording.End())}});
    for (const std::string &note : recording.Notes())
    {
        facts.push_back({{"fact", "note"}, {"text", note}});
    }
    return facts;
}

std::string NameOfLife(const Recording &recording, std::size_t life)
{
    return recording.Lives()[life].Node + "#" + std::to_string(life);
}

Json FactOfLife(const Recording &recording, std::size_t life)
{
    const RecordedLife &recorded = recording.Lives()[life];
    return {{"fact", "life"},
            {"file", NameOfLife(recording, life)},
            {"node", recorded.Node},
            {"t", Since(recording, std::max(recorded.Begin, recording.Begin()))},
            {"ended", recorded.End < recording.End() ? Json(Since(recording, recorded.End)) : Json()}};
}

std::vector<Json> FactsOfArrivals(const Recording &recording)
{
    std::vector<Json> facts;
    for (const auto &[observer, streams] : recording.Arrivals())
    {
        for (const auto &[stream, arrivals] : streams)
        {
            Json at = Json::array();
            Json posted = Json::array();
            for (const Recording::Arrival &arrival : arrivals)
            {
                at.push_back(Since(recording, arrival.At));
                posted.push_back(Since(recording, arrival.Posted));
            }
            facts.push_back({{"fact", "flown"},
                             {"at", observer},
                             {"node", stream.first},
                             {"message", stream.second},
                             {"arrived", at},
                             {"posted", posted}});
        }
    }
    return facts;
}

}  // namespace Rabit::WhatIf
