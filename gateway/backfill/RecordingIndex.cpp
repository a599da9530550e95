#include "backfill/RecordingIndex.h"

#include <rabit/base/LittleEndian.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <stdexcept>

#include "recording/RecordingName.h"
#include "recording/mcap/ChunkReader.h"
#include "recording/mcap/McapContents.h"
#include "recording/mcap/RecordCodec.h"
#include "recording/mcap/RecordScanner.h"

namespace Rabit::Backfill
{
namespace
{

// A record with a longer content, but for a chunk, is not looked at.
constexpr std::uint64_t LargestLookedAt = 16U << 20;

}  // namespace

void RecordingIndex::Refresh(bool isOver)
{
    std::set<std::string> present;
    std::error_code error;
    std::uint64_t newest = 0;
    const auto oldest = std::filesystem::file_time_type::clock::now() - LongestKept;
    for (const auto &entry : std::filesystem::directory_iterator(_folder, error))
    {
        const std::string name = entry.path().filename().string();
        const auto named = RecordingName::Of(name, _node);
        if (named && entry.is_regular_file(error) && !entry.is_symlink(error) &&
            entry.last_write_time(error) >= oldest)
        {
            present.insert(name);
            File &file = _files[name];
            file.Path = entry.path().string();
            file.Number = named->Number;
            newest = std::max(newest, named->Number);
        }
    }
    std::erase_if(_files, [&present](const auto &file) { return !present.contains(file.first); });
    for (auto &[name, file] : _files)
    {
        if (!file.IsOver)
        {
            ReadOn(file, !isOver && file.Number == newest);
        }
    }
}

void RecordingIndex::ReadOn(File &file, bool mayGrow)
try
{
    Mcap::FileSource source(file.Path);
    std::array<std::uint8_t, Mcap::RecordHead> bytes{};
    std::uint64_t offset = std::max<std::uint64_t>(file.ReadUntil, Mcap::Magic.size());
    std::uint64_t chunk = 0;
    std::uint64_t chunkLength = 0;
    // A chunk is taken with all of its indexes, or later.
    std::uint64_t whole = offset;
    std::vector<Mcap::MessageIndex> indexes;
    std::uint64_t endTime = 0;
    // False: the chunk cannot be read now.
    const auto takeChunk = [&]
    {
        const bool areKnown = std::all_of(indexes.begin(), indexes.end(),
                                          [&file](const Mcap::MessageIndex &index) {
                                              return file.Channels.contains(index.ChannelId) ||
                                                     file.OtherChannels.contains(index.ChannelId);
                                          });
        if (!areKnown && LearnChannels(file, chunk, chunkLength) == Access::Failed)
        {
            return false;
        }
        for (const Mcap::MessageIndex &index : indexes)
        {
            TakeIndex(file, chunk, chunkLength, index);
        }
        file.NewestLog = std::max(file.NewestLog, file.LastChunkEnd);
        file.LastChunkEnd = std::max(file.LastChunkEnd, endTime);
        indexes.clear();
        chunkLength = 0;
        whole = offset;
        return true;
    };
    while (offset + bytes.size() <= source.Size() && source.Read(offset, bytes))
    {
        const Mcap::Head head = Mcap::ReadHead(bytes);
        if (head.Code == 0 || head.Length > source.Size() - offset - bytes.size())
        {
            break;
        }
        const auto code = static_cast<Mcap::Opcode>(head.Code);
        if (chunkLength > 0 && code != Mcap::Opcode::MessageIndex && !takeChunk())
        {
            break;
        }
        Mcap::Bytes content;
        if ((code == Mcap::Opcode::MessageIndex || code == Mcap::Opcode::Metadata) &&
            head.Length <= LargestLookedAt)
        {
            content.resize(static_cast<std::size_t>(head.Length));
            if (!source.Read(offset + bytes.size(), content))
            {
                break;
            }
        }
        if (code == Mcap::Opcode::Chunk)
        {
            chunk = offset;
            chunkLength = bytes.size() + head.Length;
            std::array<std::uint8_t, 16> times{};
            source.Read(offset + bytes.size(), times);
            endTime = LittleEndian::Read<std::uint64_t>(std::span(times).subspan(8));
        }
        else if (code == Mcap::Opcode::MessageIndex)
        {
            if (auto index = Mcap::Read<Mcap::MessageIndex>(content); index && !index->Entries.empty())
            {
                indexes.push_back(std::move(*index));
            }
        }
        else if (code == Mcap::Opcode::Metadata)
        {
            if (auto metadata = Mcap::Read<Mcap::Metadata>(content))
            {
                file.Metadata[metadata->Name] = std::move(metadata->Values);
            }
        }
        offset += bytes.size() + head.Length;
        if (code == Mcap::Opcode::DataEnd)
        {
            file.IsOver = true;
            break;
        }
        whole = chunkLength > 0 ? whole : offset;
    }
    if (chunkLength > 0 && !mayGrow)
    {
        static_cast<void>(takeChunk());
    }
    if (file.IsOver)
    {
        LearnFromSummary(file);
    }
    if (file.IsOver || !mayGrow)
    {
        file.NewestLog = std::max(file.NewestLog, file.LastChunkEnd);
    }
    file.ReadUntil = whole;
    const auto own = file.Metadata.find("rabit.file");
    file.IsOwn =
        own != file.Metadata.end() && own->second.contains("node") && own->second.at("node") == _node;
}
catch (const std::runtime_error &)
{
    // It was removed meanwhile.
}

void RecordingIndex::TakeIndex(File &file, std::uint64_t chunk, std::uint64_t length,
                               const Mcap::MessageIndex &index)
{
    if (!file.OtherChannels.contains(index.ChannelId))
    {
        const auto [first, last] = std::minmax_element(index.Entries.begin(), index.Entries.end());
        file.Pieces.push_back({chunk, length, index.ChannelId, first->first, last->first});
    }
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

RecordingIndex::Access RecordingIndex::LearnChannels(File &file, std::uint64_t chunk, std::uint64_t length)
{
    Access access = Access::Done;
    const Mcap::Bytes *records = Open(file.Path, chunk, length, access);
    if (records == nullptr)
    {
        return access;
    }
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
    }
    return Access::Done;
}

// The summary of a file that was ended describes all channels once more.
void RecordingIndex::LearnFromSummary(File &file)
{
    const auto isKnown = [&file](const Piece &piece)
    { return file.Channels.contains(piece.Channel) || file.OtherChannels.contains(piece.Channel); };
    if (std::all_of(file.Pieces.begin(), file.Pieces.end(), isKnown))
    {
        return;
    }
    Mcap::FileSource source(file.Path);
    for (const auto &[id, channel] : Mcap::ReadContents(source).Channels)
    {
        Learn(file, channel);
    }
    std::erase_if(file.Pieces,
                  [&file](const Piece &piece) { return file.OtherChannels.contains(piece.Channel); });
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
