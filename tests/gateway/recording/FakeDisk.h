// A disk in memory with limited room. It knows which bytes would outlast a loss of power.
#pragma once

#include <rabit/mcap/McapContents.h>
#include <rabit/mcap/MessageCursor.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "MemoryFile.h"
#include "recording/RecordingDisk.h"

class FakeDisk final : public Rabit::RecordingDisk
{
public:
    struct Content
    {
        Rabit::Mcap::Bytes Bytes;
        std::size_t Synced = 0;
    };

    std::unique_ptr<File> Create(const std::string &name, std::string &reason) override
    {
        if (!CreateFails.empty() || Files.count(name) != 0)
        {
            reason = CreateFails.empty() ? "File exists" : CreateFails;
            return nullptr;
        }
        return std::make_unique<Handle>(*this,
                                        *Files.emplace(name, std::make_shared<Content>()).first->second);
    }
    std::vector<Entry> List() override
    {
        std::vector<Entry> entries;
        for (const auto &[name, content] : Files)
        {
            entries.push_back({name, content->Bytes.size() + Extra(name)});
        }
        return entries;
    }
    bool Remove(const std::string &name) override { return Files.erase(name) != 0; }
    std::optional<std::uint64_t> FreeBytes() override
    {
        std::uint64_t used = UsedByOthers;
        for (const Entry &entry : List())
        {
            used += entry.Bytes;
        }
        return used >= Capacity ? 0 : Capacity - used;
    }

    // Adds a file of this size that need not be in memory.
    void Put(const std::string &name, std::uint64_t bytes)
    {
        Files[name] = std::make_shared<Content>();
        _extra[name] = bytes;
    }
    std::vector<std::string> Names() const
    {
        std::vector<std::string> names;
        for (const auto &[name, content] : Files)
        {
            names.push_back(name);
        }
        return names;
    }
    MemoryFile Open(const std::string &name) const { return MemoryFile(Files.at(name)->Bytes); }

    std::map<std::string, std::shared_ptr<Content>> Files;
    std::uint64_t Capacity = std::uint64_t{1} << 40;
    std::uint64_t UsedByOthers = 0;
    std::string CreateFails;
    bool WriteFails = false;
    std::function<void()> BeforeWrite = [] {};

private:
    class Handle final : public File
    {
    public:
        Handle(FakeDisk &disk, Content &content) : _disk(disk), _content(content) {}
        bool Write(Rabit::Mcap::ByteView bytes) override
        {
            _disk.BeforeWrite();
            if (_disk.WriteFails || *_disk.FreeBytes() < bytes.size())
            {
                return false;
            }
            _content.Bytes.insert(_content.Bytes.end(), bytes.begin(), bytes.end());
            return true;
        }
        bool Sync() override
        {
            _content.Synced = _content.Bytes.size();
            return true;
        }

    private:
        FakeDisk &_disk;
        Content &_content;
    };

    std::uint64_t Extra(const std::string &name) const
    {
        const auto found = _extra.find(name);
        return found == _extra.end() ? 0 : found->second;
    }

    std::map<std::string, std::uint64_t> _extra;
};

// Returns the log times of all messages in a file.
inline std::vector<std::uint64_t> LogTimesOf(MemoryFile file)
{
    const Rabit::Mcap::Contents contents = Rabit::Mcap::ReadContents(file);
    Rabit::Mcap::MessageCursor cursor(file, contents, {});
    std::vector<std::uint64_t> times;
    while (const auto message = cursor.Next())
    {
        times.push_back(message->LogTime);
    }
    return times;
}

// Returns the last metadata of this name in a file.
inline Rabit::Mcap::TextMap MetadataOf(MemoryFile file, const std::string &name)
{
    return Rabit::Mcap::MetadataOf(Rabit::Mcap::ReadContents(file), name);
}
