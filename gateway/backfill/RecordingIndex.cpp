#include "backfill/RecordingIndex.h"

#include <rabit/base/LittleEndian.h>
#include <rabit/mcap/ChunkReader.h>
#include <rabit/mcap/McapContents.h>
#include <rabit/mcap/RecordCodec.h>
#include <rabit/mcap/RecordScanner.h>

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <filesystem>
#include <optional>
#include <span>
#include <stdexcept>
#include <system_error>

#include "recording/RecordingName.h"

namespace Rabit::Backfill
{
namespace
{

// A record with a longer content, but for a chunk, is not looked at.
constexpr std::uint64_t LargestLookedAt = 16U << 20;

enum class Seen
{
    File,     // that was written to of late
    Nothing,  // it was removed, is too old, or is no file
    Failed
};

Seen LookAt(const std::filesystem::path &path, std::filesystem::file_time_type oldest)
{
    std::error_code error;
    const std::filesystem::file_type type = std::filesystem::symlink_status(path, error).type();
    if (type == std::filesystem::file_type::none)
    {
        return Seen::Failed;
    }
    if (type != std::filesystem::file_type::regular)
    {
        return Seen::Nothing;
    }
    const auto writtenAt = std::filesystem::last_write_time(path, error);
    if (error)
    {
        return error == std::errc::no_such_file_or_directory ? Seen::Nothing : Seen::Failed;
    }
    return writtenAt >= oldest ? Seen::File : Seen::Nothing;
}

// True if no later look will be better: the file was removed, or this user may not read it.
bool IsOutOfReach(const std::string &path)
{
    return ::faccessat(AT_FDCWD, path.c_str(), R_OK, AT_EACCESS) != 0 && (errno == ENOENT || errno == EACCES);
}

}  // namespace

bool RecordingIndex::Refresh(bool isOver)
{
    std::set<std::string> present;
    std::uint64_t newest = 0;
    bool isWhole = true;
    const auto oldest = std::filesystem::file_time_type::clock::now() - LongestKept;
    std::error_code error;
    for (std::filesystem::directory_iterator at(_folder, error), end; !error && at != end;
         at.increment(error))
    {
        const std::string name = at->path().filename().string();
        const auto named = RecordingName::Of(name, _node);
        if (!named)
        {
            continue;
        }
        const Seen seen = LookAt(at->path(), oldest);
        if (seen != Seen::Nothing)
        {
            present.insert(name);
            File &file = _files[name];
            file.Path = at->path().string();
            file.Number = named->Number;
            newest = std::max(newest, named->Number);
        }
        isWhole = isWhole && seen != Seen::Failed;
    }
    // A folder with recordings that is missing now may be one that is not mounted.
    if (error && (error != std::errc::no_such_file_or_directory || !_files.empty()))
    {
        return false;
    }
    std::erase_if(_files, [&present](const auto &file) { return !present.contains(file.first); });
    for (auto &[name, file] : _files)
    {
        if (!file.IsOver && !ReadOn(file, !isOver && file.Number == newest))
        {
            isWhole = false;
        }
    }
    return isWhole;
}

// A chunk is taken with all of its indexes, or later.
bool RecordingIndex::ReadOn(File &file, bool mayGrow)
try
{
    Mcap::FileSource source(file.Path);
    std::array<std::uint8_t, Mcap::RecordHead> bytes{};
    std::uint64_t offset = std::max<std::uint64_t>(file.ReadUntil, Mcap::Magic.size());
    Chunk chunk;
    bool isEnded = false;
    while (!isEnded && offset + bytes.size() <= source.Size())
    {
        if (!source.Read(offset, bytes))
        {
            return false;
        }
        const Mcap::Head head = Mcap::ReadHead(bytes);
        if (head.Code == 0 || head.Length > source.Size() - offset - bytes.size())
        {
            break;
        }
        const auto code = static_cast<Mcap::Opcode>(head.Code);
        if (chunk.Length > 0 && code != Mcap::Opcode::MessageIndex && !TakeChunk(file, chunk, offset))
        {
            return false;
        }
        Mcap::Bytes content;
        if ((code == Mcap::Opcode::MessageIndex || code == Mcap::Opcode::Metadata) &&
            head.Length <= LargestLookedAt)
        {
            content.resize(static_cast<std::size_t>(head.Length));
            if (!source.Read(offset + bytes.size(), content))
            {
                return false;
            }
        }
        if (code == Mcap::Opcode::Chunk)
        {
            std::array<std::uint8_t, 16> times{};
            if (head.Length >= times.size() && !source.Read(offset + bytes.size(), times))
            {
                return false;
            }
            chunk.Offset = offset;
            chunk.Length = bytes.size() + head.Length;
            chunk.FirstLog = LittleEndian::Read<std::uint64_t>(std::span(times).subspan(0, 8));
            chunk.LastLog = LittleEndian::Read<std::uint64_t>(std::span(times).subspan(8));
        }
        else if (code == Mcap::Opcode::MessageIndex && chunk.Length > 0)
        {
            auto index = Mcap::Read<Mcap::MessageIndex>(content);
            chunk.IsIndexed = chunk.IsIndexed && index.has_value();
            if (index && !index->Entries.empty())
            {
                chunk.Indexes.push_back(std::move(*index));
            }
        }
        else if (code == Mcap::Opcode::Metadata)
        {
            if (auto metadata = Mcap::Read<Mcap::Metadata>(content))
            {
                file.Metadata[metadata->Name] = std::move(metadata->Values);
            }
        }
        isEnded = code == Mcap::Opcode::DataEnd;
        offset += bytes.size() + head.Length;
        if (chunk.Length == 0 && !isEnded)
        {
            file.ReadUntil = offset;
        }
    }
    if (chunk.Length > 0 && !mayGrow)
    {
        // The program that wrote the file was perhaps ended before the last index of this chunk.
        chunk.IsIndexed = false;
        if (!TakeChunk(file, chunk, offset))
        {
            return false;
        }
    }
    const auto own = file.Metadata.find("rabit.file");
    file.IsOwn =
        own != file.Metadata.end() && own->second.contains("node") && own->second.at("node") == _node;
    if (isEnded || !mayGrow)
    {
        file.NewestLog = std::max(file.NewestLog, file.LastChunkEnd);
    }
    if (isEnded)
    {
        LearnFromSummary(file);
        file.IsOver = true;
    }
    return true;
}
catch (const std::runtime_error &)
{
    return IsOutOfReach(file.Path);
}

// The file is read on from `end`.
bool RecordingIndex::TakeChunk(File &file, Chunk &chunk, std::uint64_t end)
{
    chunk.IsIndexed = chunk.IsIndexed && !chunk.Indexes.empty();
    const bool areKnown = std::all_of(
        chunk.Indexes.begin(), chunk.Indexes.end(),
        [&file](const Mcap::MessageIndex &index)
        { return file.Channels.contains(index.ChannelId) || file.OtherChannels.contains(index.ChannelId); });
    const Access access = chunk.IsIndexed && areKnown ? Access::Done : ReadChunk(file, chunk);
    if (access == Access::Failed)
    {
        return false;
    }
    if (access == Access::Damaged && !chunk.IsIndexed)
    {
        chunk.Indexes.clear();
        file.Pieces.push_back({chunk.Offset, chunk.Length, 0, chunk.FirstLog, chunk.LastLog, true});
    }
    for (const Mcap::MessageIndex &index : chunk.Indexes)
    {
        if (!file.OtherChannels.contains(index.ChannelId))
        {
            const auto [first, last] = std::minmax_element(index.Entries.begin(), index.Entries.end());
            file.Pieces.push_back({chunk.Offset, chunk.Length, index.ChannelId, first->first, last->first});
        }
    }
    file.NewestLog = std::max(file.NewestLog, file.LastChunkEnd);
    file.LastChunkEnd = std::max(file.LastChunkEnd, chunk.LastLog);
    file.ReadUntil = end;
    chunk = {};
    return true;
}

void RecordingIndex::Learn(File &file, const Mcap::Channel &channel) const
{
    if (_wants(channel))
    {
        file.Channels.emplace(channel.Id, channel);
    }
    else
    {
        file.OtherChannels.insert(channel.Id);
    }
}

// Learns the channels that the chunk describes. If it may lack indexes, it gets those of its messages.
RecordingIndex::Access RecordingIndex::ReadChunk(File &file, Chunk &chunk)
{
    Access access = Access::Done;
    const Mcap::Bytes *records = Open(file.Path, chunk.Offset, chunk.Length, access);
    if (records == nullptr)
    {
        return access;
    }
    std::map<std::uint16_t, Mcap::MessageIndex> indexes;
    Mcap::RecordIterator iterator(*records);
    while (const auto record = iterator.Next())
    {
        if (record->Code == static_cast<std::uint8_t>(Mcap::Opcode::Channel))
        {
            if (const auto channel = Mcap::Read<Mcap::Channel>(record->Content))
            {
                Learn(file, *channel);
            }
        }
        else if (!chunk.IsIndexed && record->Code == static_cast<std::uint8_t>(Mcap::Opcode::Message))
        {
            if (const auto message = Mcap::Read<Mcap::Message>(record->Content))
            {
                Mcap::MessageIndex &index = indexes[message->ChannelId];
                index.ChannelId = message->ChannelId;
                index.Entries.emplace_back(message->LogTime, record->Offset);
            }
        }
    }
    if (!chunk.IsIndexed)
    {
        chunk.Indexes.clear();
        for (auto &[channel, index] : indexes)
        {
            chunk.Indexes.push_back(std::move(index));
        }
    }
    return Access::Done;
}

// The summary of a file that was ended describes all channels once more.
void RecordingIndex::LearnFromSummary(File &file)
{
    const auto isKnown = [&file](const Piece &piece)
    {
        return piece.IsOfAnyChannel || file.Channels.contains(piece.Channel) ||
               file.OtherChannels.contains(piece.Channel);
    };
    if (std::all_of(file.Pieces.begin(), file.Pieces.end(), isKnown))
    {
        return;
    }
    Mcap::FileSource source(file.Path);
    for (const auto &[id, channel] : Mcap::ReadContents(source).Channels)
    {
        Learn(file, channel);
    }
    std::erase_if(file.Pieces, [&file](const Piece &piece)
                  { return !piece.IsOfAnyChannel && file.OtherChannels.contains(piece.Channel); });
}

const Mcap::Bytes *RecordingIndex::Open(const std::string &path, std::uint64_t offset, std::uint64_t length,
                                        Access &access)
{
    access = Access::Damaged;
    const auto known =
        std::find_if(_open.begin(), _open.end(),
                     [&](const OpenChunk &chunk) { return chunk.Offset == offset && chunk.Path == path; });
    if (known != _open.end())
    {
        return &known->Records;
    }
    try
    {
        Mcap::FileSource source(path);
        if (length > source.Size() || offset > source.Size() - length)
        {
            return nullptr;
        }
        Mcap::Bytes bytes(static_cast<std::size_t>(length));
        if (!source.Read(offset, bytes))
        {
            access = Access::Failed;
            return nullptr;
        }
        const auto chunk = Mcap::Read<Mcap::Chunk>(Mcap::ByteView(bytes).subspan(Mcap::RecordHead));
        Mcap::Bytes room;
        Mcap::ByteView records;
        if (!chunk || !Mcap::OpenChunk(*chunk, room, records).empty())
        {
            return nullptr;
        }
        _open.push_back({path, offset, Mcap::Bytes(records.begin(), records.end())});
    }
    catch (const std::runtime_error &)
    {
        access = Access::Failed;
        return nullptr;
    }
    if (_open.size() > MostOpenChunks)
    {
        _open.pop_front();
    }
    return &_open.back().Records;
}

RecordingIndex::Access RecordingIndex::Visit(const File &file, const Piece &piece,
                                             const std::function<void(const Mcap::Message &message)> &visit)
{
    Access access = Access::Done;
    const Mcap::Bytes *records = Open(file.Path, piece.Offset, piece.Length, access);
    if (records == nullptr)
    {
        return access;
    }
    Mcap::RecordIterator iterator(*records);
    while (const auto record = iterator.Next())
    {
        if (record->Code == static_cast<std::uint8_t>(Mcap::Opcode::Message))
        {
            const auto message = Mcap::Read<Mcap::Message>(record->Content);
            if (message && message->ChannelId == piece.Channel)
            {
                visit(*message);
            }
        }
    }
    return Access::Done;
}

}  // namespace Rabit::Backfill
