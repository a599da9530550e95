#include "FlightFile.h"

#include <rabit/mcap/ChunkReader.h>
#include <rabit/mcap/FileSource.h>
#include <rabit/mcap/McapContents.h>
#include <rabit/mcap/RecordCodec.h>
#include <rabit/mcap/RecordScanner.h>

#include <algorithm>
#include <array>
#include <stdexcept>

namespace Rabit::Facts
{
namespace
{

constexpr const char *FleetType = "Rabit::Gateway::Fleet";

}  // namespace

FlightFile::FlightFile(std::string path, const std::set<std::string> &fields)
    : _path(std::move(path)), _fields(fields)
{
}

void FlightFile::Follow(const Tell &tell)
{
    if (_ended)
    {
        return;
    }
    _tell = &tell;
    try
    {
        Mcap::FileSource source(_path);
        const std::uint64_t size = source.Size();
        if (_offset == 0 && size >= Mcap::Magic.size())
        {
            std::array<std::uint8_t, Mcap::Magic.size()> magic{};
            _ended = !source.Read(0, magic) || magic != Mcap::Magic;
            _offset = magic.size();
        }
        Mcap::Bytes content;
        while (!_ended && _offset >= Mcap::Magic.size() && size - _offset >= Mcap::RecordHead)
        {
            std::array<std::uint8_t, Mcap::RecordHead> bytes{};
            if (!source.Read(_offset, bytes))
            {
                break;
            }
            const Mcap::Head head = Mcap::ReadHead(bytes);
            const bool isGood = head.Code != 0 && head.Length <= Mcap::RecordScanner::LargestRecord;
            if (!isGood || head.Code == static_cast<std::uint8_t>(Mcap::Opcode::DataEnd))
            {
                _ended = true;
                break;
            }
            if (head.Length > size - _offset - bytes.size())
            {
                break;  // not whole yet
            }
            content.resize(static_cast<std::size_t>(head.Length));
            if (!source.Read(_offset + bytes.size(), content))
            {
                break;
            }
            _offset += bytes.size() + head.Length;
            Read(head.Code, content);
        }
    }
    catch (const std::runtime_error &)
    {
        // The file was removed, or cannot be read now; the next call tries again.
    }
    TellOfStreams();
    _tell = nullptr;
}

void FlightFile::Read(std::uint8_t code, Mcap::ByteView content)
{
    switch (static_cast<Mcap::Opcode>(code))
    {
        case Mcap::Opcode::Schema:
            if (auto schema = Mcap::Read<Mcap::Schema>(content))
            {
                const std::uint16_t id = schema->Id;
                _schemas[id] = std::move(*schema);
            }
            break;
        case Mcap::Opcode::Channel:
            if (const auto channel = Mcap::Read<Mcap::Channel>(content))
            {
                AddStream(*channel);
            }
            break;
        case Mcap::Opcode::Message:
            if (const auto message = Mcap::Read<Mcap::Message>(content))
            {
                ReadMessage(*message);
            }
            break;
        case Mcap::Opcode::Chunk:
            ReadChunk(content);
            break;
        case Mcap::Opcode::Metadata:
            if (const auto metadata = Mcap::Read<Mcap::Metadata>(content);
                metadata && metadata->Name == "rabit.node")
            {
                (*_tell)({{"fact", "about"},
                          {"file", _path},
                          {"domain", Mcap::ValueOf(metadata->Values, "domain")},
                          {"transport", Mcap::ValueOf(metadata->Values, "transport")}});
            }
            break;
        default:
            break;
    }
}

void FlightFile::ReadChunk(Mcap::ByteView content)
{
    const auto chunk = Mcap::Read<Mcap::Chunk>(content);
    Mcap::Bytes room;
    Mcap::ByteView records;
    if (!chunk || !Mcap::OpenChunk(*chunk, room, records).empty())
    {
        return;
    }
    Mcap::RecordIterator iterator(records);
    while (const auto record = iterator.Next())
    {
        if (record->Code != static_cast<std::uint8_t>(Mcap::Opcode::Chunk))
        {
            Read(record->Code, record->Content);
        }
    }
}

void FlightFile::AddStream(const Mcap::Channel &channel)
{
    if (_streams.contains(channel.Id))
    {
        return;
    }
    const auto schema = _schemas.find(channel.SchemaId);
    Stream stream{channel.Topic, schema == _schemas.end() ? "" : schema->second.Name,
                  Mcap::Describe(channel)};
    if (stream.IsOwn() && _fields.contains(stream.Is.Message) && schema != _schemas.end())
    {
        stream.Type = DynamicType::Parse(schema->second.Data, stream.Schema).Type;
    }
    _streams.emplace(channel.Id, std::move(stream));
}

void FlightFile::ReadMessage(const Mcap::Message &message)
{
    const auto found = _streams.find(message.ChannelId);
    if (found == _streams.end())
    {
        return;
    }
    Stream &stream = found->second;
    if (stream.Schema == FleetType && stream.IsOwn())
    {
        for (Json &fact : _fleet.Look(message.Data))
        {
            Put(message.LogTime, std::move(fact));
        }
    }
    else if (stream.IsOwn() || stream.Is.Kind == Mcap::ChannelKind::Mirrored)
    {
        stream.At.push_back(message.LogTime);
        stream.Posted.push_back(message.PublishTime);
        if (stream.Type)
        {
            stream.Newest.assign(message.Data.begin(), message.Data.end());
            stream.NewestAt = message.LogTime;
        }
    }
    else if (stream.Is.Kind == Mcap::ChannelKind::Recorder)
    {
        ReadJson(stream, message);
    }
}

void FlightFile::ReadJson(const Stream &stream, const Mcap::Message &message)
{
    const bool isLog = stream.Topic == stream.Is.Node + "/Recorder/Log";
    if (!isLog && stream.Topic != stream.Is.Node + "/Recorder/Outcomes")
    {
        return;
    }
    const Json json = Json::parse(message.Data.begin(), message.Data.end(), nullptr, false);
    if (!json.is_object())
    {
        return;
    }
    if (isLog)
    {
        Put(message.LogTime, {{"fact", "log"},
                              {"level", json.value("level", Json())},
                              {"text", json.value("message", Json())}});
        return;
    }
    Json fact = {{"fact", "outcome"}};
    for (const char *key : {"node", "queue", "outcome", "reason"})
    {
        fact[key] = json.value(key, Json());
    }
    Put(message.LogTime, std::move(fact));
}

void FlightFile::TellOfStreams()
{
    for (auto &[id, stream] : _streams)
    {
        if (!stream.At.empty())
        {
            Put(stream.At.back(), {{"fact", "values"},
                                   {"message", stream.Is.Message},
                                   {"node", stream.Is.Node},
                                   {"own", stream.IsOwn()},
                                   {"at", stream.At},
                                   {"posted", stream.Posted}});
            stream.At.clear();
            stream.Posted.clear();
        }
        if (stream.NewestAt != 0)
        {
            if (const auto text = stream.Type->ToJson(stream.Newest))
            {
                Put(stream.NewestAt, {{"fact", "fields"},
                                      {"message", stream.Is.Message},
                                      {"value", Json::parse(*text, nullptr, false)}});
            }
            stream.NewestAt = 0;
        }
    }
}

void FlightFile::Put(std::uint64_t time, Json fact)
{
    fact["file"] = _path;
    fact["t"] = time;
    (*_tell)(std::move(fact));
}

}  // namespace Rabit::Facts
