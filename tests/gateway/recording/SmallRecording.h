// A recording of some messages on two channels, one of them with pictures, in several chunks.
#pragma once

#include <rabit/mcap/McapWriter.h>

#include <cstdint>
#include <string>
#include <vector>

#include "MemoryFile.h"

struct SmallRecording
{
    // The size of the file and the number of messages in it, each time that the chunks were finished.
    struct Mark
    {
        std::size_t Bytes = 0;
        std::size_t Messages = 0;
    };
    struct Sent
    {
        std::string Topic;
        std::uint64_t LogTime = 0;
        Rabit::Mcap::Bytes Data;
    };

    explicit SmallRecording(bool compresses = true)
    {
        using namespace Rabit::Mcap;
        McapWriter writer(File, {"rabit test", "rabit", compresses});
        const std::uint16_t schema = writer.AddSchema("Uav::Pose", "omgidl", "module Uav {};");
        const std::uint16_t pose = *writer.AddChannel(schema, "uav1/Pose", "cdr", {{"node", "uav1"}});
        const std::uint16_t picture = *writer.AddChannel(schema, "uav1/Picture", "cdr");
        writer.AddMetadata({"rabit.configuration", {{"node", "uav1"}}});
        const Bytes blob = {1, 2, 3};
        writer.AddAttachment({5, 4, "uav1.yaml", "application/yaml", blob});
        for (std::uint64_t time = 1000; time < 1012; ++time)
        {
            const bool isPicture = time % 5 == 0;
            const Bytes data(isPicture ? McapWriter::LargeMessage : 40, static_cast<std::uint8_t>(time));
            const std::uint16_t channel = isPicture ? picture : pose;
            writer.Add({channel, static_cast<std::uint32_t>(time - 999), time, time - 1, data});
            Messages.push_back({isPicture ? "uav1/Picture" : "uav1/Pose", time, data});
            if (time % 3 == 0)
            {
                writer.FinishChunks();
                Marks.push_back({File.Content.size(), Messages.size()});
            }
        }
        writer.Finish();
        Marks.push_back({File.Content.size(), Messages.size()});
    }

    MemoryFile File;
    std::vector<Sent> Messages;
    std::vector<Mark> Marks;
};
