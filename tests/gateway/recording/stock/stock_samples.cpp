// Writes recordings for the test with the stock reader, and files that list their contents:
//   stock_samples FOLDER
// small.mcap and small.json: the least number of messages in the first N bytes, for several N.
// corpus.mcap and corpus.jsonl: samples of every type; each line is the value of a message, as JSON.
#include <rabit/dynamic/DynamicType.h>
#include <rabit/gateway/SchemaText.h>
#include <rabit/idl/MessageTypeRegistry.h>
#include <rabit/mcap/McapWriter.h>

#include <fstream>
#include <iostream>
#include <random>
#include <string>

#include "MemoryFile.h"
#include "RandomSample.h"
#include "Samples.h"
#include "dynamic/ReadType.h"

namespace
{

using namespace Rabit::Mcap;

void Save(const std::string &path, const MemoryFile &file)
{
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char *>(file.Content.data()),
               static_cast<std::streamsize>(file.Content.size()));
}

void WriteSmall(const std::string &folder)
{
    MemoryFile file;
    std::ofstream marks(folder + "/small.json");
    McapWriter writer(file, {"rabit test", "rabit", true});
    const std::uint16_t schema = writer.AddSchema(
        "Uav::GoHome", "omgidl", "module Uav {\n@final\nstruct GoHome {\n    string reason;\n};\n};\n");
    std::vector<std::uint16_t> channels;
    writer.AddMetadata({"rabit.configuration", {{"node", "uav1"}}});
    std::size_t messages = 0;
    const Bytes data = {0, 1, 0, 0, 4, 0, 0, 0, 'b', 'a', 't', 0};
    for (std::uint64_t chunk = 0; chunk < 6; ++chunk)
    {
        // Some channels come later.
        if (chunk % 2 == 0)
        {
            channels.push_back(*writer.AddChannel(schema, "uav" + std::to_string(chunk) + "/Health", "cdr"));
        }
        for (const std::uint16_t channel : channels)
        {
            const std::uint64_t time = 1000000 * chunk + channel;
            writer.Add({channel, 0, time, time, data});
            ++messages;
        }
        writer.FinishChunks();
        marks << (chunk == 0 ? "[" : ",\n") << "[" << file.Content.size() << ", " << messages << "]";
    }
    const Bytes blob = {1, 2, 3};
    writer.AddAttachment({5, 4, "uav1.yaml", "application/yaml", blob});
    writer.Finish();
    marks << "]\n";
    Save(folder + "/small.mcap", file);
}

class Corpus
{
public:
    explicit Corpus(const std::string &folder)
        : _folder(folder), _values(folder + "/corpus.jsonl"), _writer(_file, {"rabit test", "rabit", true})
    {
    }

    void Write()
    {
        for (const std::string &name : Rabit::MessageTypeRegistry::Names())
        {
            const Rabit::MessageType &type = *Rabit::MessageTypeRegistry::Find(name);
            const auto parsed = Rabit::DynamicType::Parse(type.IdlText(), name);
            std::string reason;
            const auto shapes = Rabit::Dynamic::ReadType(type.IdlText(), name, reason);
            const std::uint16_t schema = _writer.AddSchema(name, "omgidl", Rabit::SchemaText(type.IdlText()));
            const std::uint16_t channel = *_writer.AddChannel(schema, name, "cdr");
            Add(channel, *parsed.Type, parsed.Type->DefaultSample());
            for (const Sample &sample : AllSamples())
            {
                if (type.IsTypeOf(*sample.Message))
                {
                    Add(channel, *parsed.Type, BytesOf(*sample.Message));
                }
            }
            std::mt19937 random(1U);
            const bool isLarge = parsed.Type->DefaultSample().size() > 2000 ||
                                 type.IdlText().find("octet page[") != std::string::npos;
            for (int round = 0; round < (isLarge ? 2 : 20); ++round)
            {
                Add(channel, *parsed.Type, RandomSample(*shapes->Root, round % 2 == 0, random));
            }
        }
        _writer.Finish();
        Save(_folder + "/corpus.mcap", _file);
    }

private:
    void Add(std::uint16_t channel, const Rabit::DynamicType &type, const Bytes &sample)
    {
        _values << type.ToJson(sample).value() << '\n';
        ++_time;
        _writer.Add({channel, 0, _time, _time, sample});
    }

    const std::string _folder;
    std::ofstream _values;
    MemoryFile _file;
    McapWriter _writer;
    std::uint64_t _time = 0;
};

}  // namespace

int main(int argc, char **argv)
{
    if (argc != 2)
    {
        std::cerr << "usage: stock_samples FOLDER\n";
        return 2;
    }
    WriteSmall(argv[1]);
    Corpus(argv[1]).Write();
    return 0;
}
