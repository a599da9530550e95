// A recording in memory, as a node writes it, for tests of replay.
#pragma once

#include <rabit/mcap/McapContents.h>
#include <rabit/mcap/McapWriter.h>

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "MemoryFile.h"

class PlayedFile
{
public:
    using TextMap = Rabit::Mcap::TextMap;

    explicit PlayedFile(const std::string &recorder, const TextMap &more = {})
    {
        TextMap about = more;
        about["node"] = recorder;
        _writer.AddMetadata({"rabit.node", about});
    }

    void AddMetadata(const std::string &name, const TextMap &values) { _writer.AddMetadata({name, values}); }
    std::uint16_t Channel(const std::string &topic, const TextMap &metadata,
                          const std::string &type = "Uav::Pose", const std::string &encoding = "cdr",
                          const std::string &text = "text")
    {
        const std::uint16_t schema =
            _writer.AddSchema(type, encoding == "cdr" ? "omgidl" : "jsonschema", text);
        return *_writer.AddChannel(schema, topic, encoding, metadata);
    }
    std::uint16_t Posted(const std::string &node, const std::string &message, const std::string &qos = "")
    {
        return Message("posted", node, message, qos);
    }
    std::uint16_t Mirrored(const std::string &node, const std::string &message)
    {
        return Message("mirrored", node, message, "");
    }
    // `what`: sent or received.
    std::uint16_t Queue(const std::string &recorder, const std::string &what, const std::string &peer,
                        const std::string &queue)
    {
        return Channel(recorder + "/Recorder/" + what + "/" + peer + "/" + queue + "/Uav::Goto",
                       {{"rabit.kind", "queue " + what},
                        {"rabit.node", recorder},
                        {"rabit.peer", peer},
                        {"rabit.queue", queue}},
                       "Uav::Goto");
    }
    void Fleet(const std::string &recorder)
    {
        Channel(recorder + "/Gateway/Fleet", {{"rabit.kind", "posted"}, {"rabit.node", recorder}},
                "Rabit::Gateway::Fleet");
    }
    void Add(std::uint16_t channel, std::uint64_t logTime, std::uint8_t value,
             std::optional<std::uint64_t> published = std::nullopt)
    {
        const Rabit::Mcap::Bytes bytes = {value};
        _writer.Add({channel, 0, logTime, published.value_or(logTime), bytes});
    }
    void FinishChunk() { _writer.FinishChunks(); }

    // Ends the file and returns its contents.
    const Rabit::Mcap::Contents &Contents()
    {
        if (!_contents)
        {
            _writer.Finish();
            _contents = Rabit::Mcap::ReadContents(_file);
        }
        return *_contents;
    }
    MemoryFile &File() { return _file; }

private:
    std::uint16_t Message(const std::string &kind, const std::string &node, const std::string &message,
                          const std::string &qos)
    {
        TextMap metadata = {{"rabit.kind", kind}, {"rabit.node", node}};
        if (!qos.empty())
        {
            metadata["rabit.qos"] = qos;
        }
        return Channel(node + "/" + message, metadata);
    }

    MemoryFile _file;
    Rabit::Mcap::McapWriter _writer{_file, {}};
    std::optional<Rabit::Mcap::Contents> _contents;
};
