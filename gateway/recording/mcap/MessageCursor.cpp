#include <rabit/mcap/MessageCursor.h>

#include <rabit/mcap/ChunkReader.h>
#include <rabit/mcap/RecordCodec.h>
#include <rabit/mcap/RecordScanner.h>

#include <algorithm>
#include <utility>

namespace Rabit::Mcap
{

struct MessageCursor::Loaded
{
    std::uint64_t Offset = 0;  // of the chunk in the file
    Bytes Record;
    Bytes Room;
    ByteView Records;
    std::vector<Entry> Entries;
    std::size_t At = 0;

    const Entry &Front() const { return Entries[At]; }
    std::size_t Size() const { return Record.size() + Room.size() + Entries.capacity() * sizeof(Entry); }
};

bool MessageCursor::Later::operator()(const std::shared_ptr<Loaded> &left,
                                      const std::shared_ptr<Loaded> &right) const
{
    return std::pair(left->Front().Time, left->Offset) > std::pair(right->Front().Time, right->Offset);
}

MessageCursor::MessageCursor(ByteSource &source, const Contents &contents, Selection selection)
    : _source(source), _selection(std::move(selection))
{
    for (const ChunkIndex &chunk : contents.Chunks)
    {
        if (chunk.StartTime <= _selection.To && chunk.EndTime >= _selection.From)
        {
            _chunks.push_back(&chunk);
        }
    }
    std::stable_sort(_chunks.begin(), _chunks.end(),
                     [](const ChunkIndex *left, const ChunkIndex *right)
                     { return left->StartTime < right->StartTime; });
}

MessageCursor::~MessageCursor() = default;

std::optional<Message> MessageCursor::Next()
{
    if (_current)
    {
        if (++_current->At < _current->Entries.size())
        {
            _loaded.push(std::move(_current));
        }
        else
        {
            _bytes -= _current->Size();
        }
        _current.reset();
    }
    while (_next < _chunks.size() &&
           (_loaded.empty() || _chunks[_next]->StartTime <= _loaded.top()->Front().Time))
    {
        Load(*_chunks[_next++]);
    }
    if (_loaded.empty())
    {
        return std::nullopt;
    }
    _current = _loaded.top();
    _loaded.pop();
    return Read<Message>(RecordIterator(_current->Records.subspan(_current->Front().Offset)).Next()->Content);
}

void MessageCursor::Load(const ChunkIndex &index)
{
    const auto loaded = std::make_shared<Loaded>();
    std::string reason = LoadInto(index, *loaded);
    if (reason.empty() && _bytes + loaded->Size() > MostBytes)
    {
        reason = "too many chunks are of the same time";
    }
    if (!reason.empty())
    {
        if (_problems.size() < Contents::MostProblems)
        {
            _problems.push_back("the chunk at " + std::to_string(index.Offset) +
                                " cannot be read: " + reason);
        }
        return;
    }
    if (!loaded->Entries.empty())
    {
        _bytes += loaded->Size();
        _loaded.push(loaded);
    }
}

std::string MessageCursor::LoadInto(const ChunkIndex &index, Loaded &loaded)
{
    const std::uint64_t size = _source.Size();
    if (index.Length < RecordHead || index.Length > RecordScanner::LargestRecord || index.Offset > size ||
        index.Length > size - index.Offset)
    {
        return "it is not where it is said to be";
    }
    loaded.Offset = index.Offset;
    loaded.Record.resize(static_cast<std::size_t>(index.Length));
    if (!_source.Read(index.Offset, loaded.Record))
    {
        return "the file cannot be read";
    }
    const auto record = RecordIterator(loaded.Record).Next();
    const auto chunk = record && record->Code == static_cast<std::uint8_t>(Opcode::Chunk)
                           ? Read<Chunk>(record->Content)
                           : std::nullopt;
    if (!chunk)
    {
        return "there is no chunk";
    }
    if (std::string reason = OpenChunk(*chunk, loaded.Room, loaded.Records); !reason.empty())
    {
        return reason;
    }
    RecordIterator records(loaded.Records);
    while (const auto inner = records.Next())
    {
        const auto message = inner->Code == static_cast<std::uint8_t>(Opcode::Message)
                                 ? Read<Message>(inner->Content)
                                 : std::nullopt;
        if (message && message->LogTime >= _selection.From && message->LogTime <= _selection.To &&
            (!_selection.Wants || _selection.Wants(message->ChannelId)))
        {
            loaded.Entries.push_back({message->LogTime, inner->Offset});
        }
    }
    std::stable_sort(loaded.Entries.begin(), loaded.Entries.end(),
                     [](const Entry &left, const Entry &right) { return left.Time < right.Time; });
    return {};
}

}  // namespace Rabit::Mcap
