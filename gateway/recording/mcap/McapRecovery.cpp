#include <rabit/mcap/McapRecovery.h>

#include <rabit/mcap/ChunkReader.h>
#include <rabit/mcap/RecordCodec.h>
#include <rabit/mcap/RecordScanner.h>

#include <algorithm>
#include <map>

namespace Rabit::Mcap
{
namespace
{

class Recovery
{
public:
    Recovery(ByteSource &source, McapWriter &writer)
        : _source(source), _writer(writer), _contents(ScanContents(source))
    {
    }

    Recovered Run()
    {
        _recovered.Problems = _contents.Problems;
        for (const Metadata &metadata : _contents.MetadataRecords)
        {
            _writer.AddMetadata(metadata);
        }
        RecordScanner scanner(_source);
        while (const auto record = scanner.Next())
        {
            const auto code = static_cast<Opcode>(record->Code);
            if (code == Opcode::DataEnd)
            {
                break;
            }
            if (!record->IsPassedOver)
            {
                Take(code, *record);
            }
        }
        _recovered.IsWritten = _writer.Finish();
        return _recovered;
    }

private:
    void Take(Opcode code, const RecordScanner::Record &record)
    {
        const ByteView content = record.Content;
        if (code == Opcode::Message)
        {
            TakeMessage(content);
        }
        else if (code == Opcode::Chunk)
        {
            const auto chunk = Read<Chunk>(content);
            ByteView records;
            if (!chunk || !OpenChunk(*chunk, _room, records).empty())
            {
                return;
            }
            RecordIterator inner(records);
            while (const auto next = inner.Next())
            {
                if (next->Code == static_cast<std::uint8_t>(Opcode::Message))
                {
                    TakeMessage(next->Content);
                }
            }
        }
        else if (code == Opcode::Attachment && IsListed(record.Offset))
        {
            if (const auto attachment = Read<Attachment>(content))
            {
                _writer.AddAttachment(*attachment);
            }
        }
    }

    // True for an attachment within the limits of Contents: the writer holds what lists it, too.
    bool IsListed(std::uint64_t offset) const
    {
        const auto found =
            std::lower_bound(_contents.Attachments.begin(), _contents.Attachments.end(), offset,
                             [](const AttachmentIndex &attachment, std::uint64_t wanted)
                             { return attachment.Offset < wanted; });
        return found != _contents.Attachments.end() && found->Offset == offset;
    }

    void TakeMessage(ByteView content)
    {
        auto message = Read<Message>(content);
        const auto channel = message ? ChannelOf(message->ChannelId) : std::nullopt;
        if (!channel)
        {
            ++_recovered.LostMessages;
            return;
        }
        message->ChannelId = *channel;
        if (_writer.Add(*message))
        {
            ++_recovered.Messages;
        }
        else
        {
            ++_recovered.LostMessages;
        }
    }

    // The number of a channel in the other file.
    std::optional<std::uint16_t> ChannelOf(std::uint16_t id)
    {
        if (const auto known = _channels.find(id); known != _channels.end())
        {
            return known->second;
        }
        const auto found = _contents.Channels.find(id);
        if (found == _contents.Channels.end())
        {
            return std::nullopt;
        }
        const Channel &channel = found->second;
        const auto made = _writer.AddChannel(SchemaOf(channel.SchemaId), channel.Topic,
                                             channel.MessageEncoding, channel.Metadata);
        if (made)
        {
            _channels.emplace(id, *made);
        }
        return made;
    }

    std::uint16_t SchemaOf(std::uint16_t id)
    {
        const auto found = _contents.Schemas.find(id);
        if (found == _contents.Schemas.end())
        {
            return 0;
        }
        const auto [known, isNew] = _schemas.try_emplace(id);
        if (isNew)
        {
            const Schema &schema = found->second;
            known->second = _writer.AddSchema(schema.Name, schema.Encoding, schema.Data);
        }
        return known->second;
    }

    ByteSource &_source;
    McapWriter &_writer;
    const Contents _contents;
    Recovered _recovered;
    std::map<std::uint16_t, std::uint16_t> _channels;
    std::map<std::uint16_t, std::uint16_t> _schemas;
    Bytes _room;
};

}  // namespace

Recovered Recover(ByteSource &source, McapWriter &writer)
{
    return Recovery(source, writer).Run();
}

}  // namespace Rabit::Mcap
