#pragma once

#include <rabit/dynamic/DynamicType.h>
#include <rabit/mcap/McapRecords.h>
#include <rabit/mcap/RecordedChannel.h>

#include <nlohmann/json.hpp>

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "FleetFacts.h"

namespace Rabit::Facts
{

// A recording of one node that may still be growing. No content of the file makes it throw: a damaged file is
// read no further. One thread.
class FlightFile
{
public:
    using Json = nlohmann::ordered_json;
    using Tell = std::function<void(Json)>;

    // `fields` names the node's own messages whose values are told.
    FlightFile(std::string path, const std::set<std::string> &fields);
    // Reads what has come since the last call, and tells of it. Each fact has "file" and "t", the log time in
    // nanoseconds. In addition to those of FleetFacts:
    //   {"fact": "values", "message": NAME, "node": ORIGIN, "own": BOOL, "at": [NS...], "posted": [NS...]}
    //   {"fact": "fields", "message": NAME, "value": {...}}   the newest
    //   {"fact": "about", "domain": TEXT, "transport": TEXT}    of the node, without "t"
    //   {"fact": "log", "level": 1 to 4, "text": TEXT}
    //   {"fact": "outcome", "node": NODE, "queue": NAME, "outcome": TEXT, "reason": TEXT}
    void Follow(const Tell &tell);

private:
    struct Stream
    {
        std::string Topic;
        std::string Schema;
        Mcap::RecordedChannel Is;
        std::shared_ptr<const DynamicType> Type{};  // of values that are told
        std::vector<std::uint64_t> At{};
        std::vector<std::uint64_t> Posted{};
        Mcap::Bytes Newest{};
        std::uint64_t NewestAt = 0;

        bool IsOwn() const { return Is.Kind == Mcap::ChannelKind::Posted; }
    };

    void Read(std::uint8_t code, Mcap::ByteView content);
    void ReadChunk(Mcap::ByteView content);
    void AddStream(const Mcap::Channel &channel);
    void ReadMessage(const Mcap::Message &message);
    void ReadJson(const Stream &stream, const Mcap::Message &message);
    void TellOfStreams();
    void Put(std::uint64_t time, Json fact);

    const std::string _path;
    const std::set<std::string> &_fields;
    const Tell *_tell = nullptr;
    std::uint64_t _offset = 0;
    bool _ended = false;
    std::map<std::uint16_t, Mcap::Schema> _schemas;
    std::map<std::uint16_t, Stream> _streams;
    FleetFacts _fleet;
};

}  // namespace Rabit::Facts
