#include "recording/RecordingFiles.h"

#include <rabit/RabitVersion.h>
#include <rabit/base/UtcText.h>

#include <algorithm>
#include <cstdio>
#include <utility>

#include "recording/RecordingName.h"

namespace Rabit
{
namespace
{

constexpr std::uint64_t Second = 1000000000;
const std::string NoMore = "the disk takes no more";

std::uint64_t Nanoseconds(std::chrono::nanoseconds duration)
{
    return static_cast<std::uint64_t>(duration.count());
}

std::string Mebibytes(std::uint64_t bytes)
{
    return std::to_string(bytes >> 20);
}

std::string DateOf(std::uint64_t time)
{
    return UtcText(static_cast<std::time_t>(time / Second), "%Y%m%dT%H%M%SZ");
}

// Returns the number in the name of one of this node's files; empty if it is another file.
std::optional<std::uint64_t> NumberOf(const std::string &file, const std::string &node)
{
    const auto name = RecordingName::Of(file, node);
    return name && name->IsOriginal ? std::optional(name->Number) : std::nullopt;
}

}  // namespace

RecordingFiles::RecordingFiles(RecordingDisk &disk, const RecordingSettings &settings)
    : _disk(disk), _settings(settings)
{
}

void RecordingFiles::Take(const RecordingInbox::Batch &batch, Time now)
{
    AddNewStreams(batch);
    for (const Mcap::Metadata &metadata : batch.Metadata)
    {
        _metadata[metadata.Name] = metadata.Values;
        if (_writer)
        {
            _writer->AddMetadata(metadata);
        }
    }
    for (std::size_t stream = 0; stream < batch.Lost.size(); ++stream)
    {
        const std::uint64_t before = std::exchange(_streams[stream].LostBefore, batch.Lost[stream]);
        if (batch.Lost[stream] > before)
        {
            _status.Lost[_streams[stream].Info->Topic] += batch.Lost[stream] - before;
            _lossesChanged = true;
        }
    }
    for (const RecordingItem &item : batch.Items)
    {
        Stream &stream = _streams[item.Stream];
        const bool isOpen = _writer || (now >= _notBefore && Open(now, item.LogTime));
        if (!isOpen || !Write(stream, item, item.LogTime))
        {
            Lose(stream, 1);
            _status.NotKept += isOpen && _writer->IsGood() ? 0 : 1;  // else it is too large
        }
        KeepLast(stream, item);
        if (_writer && !_writer->IsGood())
        {
            GiveUp(now, NoMore);
        }
        else if (_writer && _writer->BytesToWrite() >= _settings.Record.SplitSize)
        {
            Finish(now);
        }
    }
}

// Adds the new streams of a batch once, whether Take or Remember comes first.
void RecordingFiles::AddNewStreams(const RecordingInbox::Batch &batch)
{
    for (std::size_t at = _streams.size(); at < batch.FirstNewStream + batch.NewStreams.size(); ++at)
    {
        _streams.push_back({batch.NewStreams[at - batch.FirstNewStream], std::nullopt, 0, 0, std::nullopt});
    }
}

void RecordingFiles::Remember(const RecordingInbox::Batch &batch, const std::vector<RecordingItem> &items)
{
    AddNewStreams(batch);
    for (const RecordingItem &item : items)
    {
        KeepLast(_streams[item.Stream], item);
    }
}

void RecordingFiles::KeepLast(Stream &stream, const RecordingItem &item)
{
    if (stream.Info->IsState && item.Data.size() <= LargestRepeated)
    {
        stream.Last = item;
    }
}

void RecordingFiles::Service(Time now)
{
    if (_writer && now >= _openedAt + Nanoseconds(_settings.Record.SplitTime))
    {
        Finish(now);
    }
    if (now >= _nextLook)
    {
        _nextLook = now + Nanoseconds(LookPeriod);
        if (_writer && !MakeRoom(Margin()))
        {
            WriteLosses();
            Finish(now);
            _notBefore = now + Nanoseconds(LookPeriod);
        }
        else if (_writer)
        {
            WriteLosses();
        }
    }
    if (_writer && now >= _flushedAt + Nanoseconds(FlushPeriod))
    {
        Flush(now);
    }
    _status.Bytes = _bytesBefore + (_writer ? _writer->BytesWritten() : 0);
}

void RecordingFiles::Abandon(const std::string &problem, Time now)
{
    if (_writer)
    {
        GiveUp(now, problem);
    }
    _status.Problem = problem;
}

std::uint64_t RecordingFiles::Margin() const
{
    return std::max(_settings.Record.Free, LeastMargin);
}

void RecordingFiles::Close(Time now)
{
    // Losses while there was no file are written to a file that holds nothing else.
    if (!_writer && _lossesChanged)
    {
        Open(now, now);
    }
    if (_writer)
    {
        WriteLosses();
        Finish(now);
    }
}

bool RecordingFiles::Open(Time now, Time firstLogTime)
{
    _notBefore = now + Nanoseconds(LookPeriod);  // if it fails
    // After a problem 10 % more must be free, so that the new file does not end after a moment.
    if (!MakeRoom(_status.Problem.empty() ? Margin() : Margin() + Margin() / 10))
    {
        return false;
    }
    if (!_number)
    {
        const auto own = OwnFiles();
        _number = own.empty() ? 1 : *NumberOf(own.back().first, _settings.Name) + 1;
    }
    const std::string stem = RecordingName::Stem(_settings.Name, *_number, DateOf(now));
    const std::string name = stem + std::string(RecordingName::End);
    std::string reason;
    _file = _disk.Create(name, reason);
    if (!_file)
    {
        _status.Problem = reason;
        _number.reset();  // somebody else may have taken it
        return false;
    }
    _status.File = name;
    _status.LastFile = name;
    _begun.push_back(name);
    ++_status.Files;
    _writer = std::make_unique<Mcap::McapWriter>(
        *_file, Mcap::McapWriter::Options{"rabit " RABIT_VERSION_STRING, "rabit", _settings.Compresses});
    _recording = _recording.empty() ? stem : _recording;
    _writer->AddMetadata({"rabit.file",
                          {{"node", _settings.Name},
                           {"number", std::to_string(*_number)},
                           {"begun", DateOf(now)},
                           {"recording", _recording}}});
    for (const auto &[key, values] : _metadata)
    {
        _writer->AddMetadata({key, values});
    }
    ++*_number;
    _openedAt = now;
    _flushedAt = now;
    _lossesChanged = _lossesChanged || !_status.Lost.empty();
    RepeatStates(firstLogTime);
    if (!_writer->IsGood())
    {
        GiveUp(now, NoMore);
        return false;
    }
    _notBefore = now;
    _status.Problem.clear();
    return true;
}

void RecordingFiles::RepeatStates(Time logTime)
{
    for (Stream &stream : _streams)
    {
        if (stream.Last)
        {
            // The first message of a file may be older than the state: it came late.
            Write(stream, *stream.Last, std::max(logTime, stream.Last->LogTime));
        }
    }
}

bool RecordingFiles::Write(Stream &stream, const RecordingItem &item, Time logTime)
{
    const auto channel = ChannelOf(stream);
    if (!channel || !_writer->Add({*channel, item.Sequence, logTime, item.PublishTime, item.Data}))
    {
        return false;
    }
    ++stream.Unsaved;
    ++_status.Messages;
    return true;
}

std::optional<std::uint16_t> RecordingFiles::ChannelOf(Stream &stream)
{
    if (stream.Channel)
    {
        return stream.Channel;
    }
    const RecordingStream &info = *stream.Info;
    std::uint16_t schema = 0;
    if (!info.SchemaName.empty())
    {
        const auto [known, isNew] = _schemas.try_emplace({info.SchemaName, info.SchemaText});
        if (isNew)
        {
            known->second = _writer->AddSchema(info.SchemaName, info.SchemaEncoding, info.SchemaText);
        }
        schema = known->second;
    }
    stream.Channel = _writer->AddChannel(schema, info.Topic, info.Encoding, info.Metadata);
    return stream.Channel;
}

void RecordingFiles::Flush(Time now)
{
    _flushedAt = now;
    if (!_writer->FinishChunks() || !_file->Sync())
    {
        GiveUp(now, NoMore);
        return;
    }
    for (Stream &stream : _streams)
    {
        stream.Unsaved = 0;
    }
}

void RecordingFiles::GiveUp(Time now, const std::string &problem)
{
    _status.Problem = problem;
    _notBefore = now + Nanoseconds(LookPeriod);
    for (Stream &stream : _streams)
    {
        _status.Messages -= stream.Unsaved;
        _status.NotKept += stream.Unsaved;
        Lose(stream, stream.Unsaved);
    }
    Forget();
}

void RecordingFiles::Finish(Time now)
{
    if (_writer->Finish() && _file->Sync())
    {
        Forget();
    }
    else
    {
        GiveUp(now, NoMore);
    }
}

void RecordingFiles::Forget()
{
    _bytesBefore += _writer->BytesWritten();
    _writer.reset();
    _file.reset();
    _status.File.clear();
    _schemas.clear();
    for (Stream &stream : _streams)
    {
        stream.Channel.reset();
        stream.Unsaved = 0;
    }
}

std::vector<std::pair<std::string, std::uint64_t>> RecordingFiles::OwnFiles()
{
    std::vector<std::pair<std::string, std::uint64_t>> own;
    for (const RecordingDisk::Entry &entry : _disk.List())
    {
        if (NumberOf(entry.Name, _settings.Name))
        {
            own.emplace_back(entry.Name, entry.Bytes);
        }
    }
    std::sort(own.begin(), own.end(),
              [this](const auto &left, const auto &right)
              {
                  return std::pair(*NumberOf(left.first, _settings.Name), left.first) <
                         std::pair(*NumberOf(right.first, _settings.Name), right.first);
              });
    return own;
}

bool RecordingFiles::Remove(std::string name, const std::string &why)
{
    if (!_disk.Remove(name))
    {
        return false;
    }
    std::erase(_begun, name);  // by value: `name` may have been one of them
    _removals.push_back("removed " + _settings.Record.Folder + "/" + name + ", the oldest file of " + why);
    return true;
}

void RecordingFiles::KeepWithinBytes()
{
    const auto own = OwnFiles();
    std::uint64_t total = 0;
    for (const auto &[name, bytes] : own)
    {
        total += bytes;
    }
    for (const auto &[name, bytes] : own)
    {
        if (total <= _settings.Record.Keep || name == _status.File)
        {
            return;
        }
        if (Remove(name, _settings.Name + ": its files took more than the " +
                             Mebibytes(_settings.Record.Keep) + " MiB that are kept"))
        {
            total -= bytes;
        }
    }
}

// Removes the oldest file of this recording, but not its last one: that may be the only one of this flight.
bool RecordingFiles::RemoveOwnStart()
{
    for (std::size_t at = 0; _settings.RemovesOwnStart && at + 1 < _begun.size(); ++at)
    {
        if (Remove(_begun[at], "this recording: less than " + Mebibytes(Margin()) + " MiB were free"))
        {
            return true;
        }
    }
    return false;
}

bool RecordingFiles::MakeRoom(std::uint64_t margin)
{
    if (_settings.Record.Keep != 0)
    {
        KeepWithinBytes();
    }
    std::optional<std::uint64_t> free = _disk.FreeBytes();
    while (free && *free < margin && RemoveOwnStart())
    {
        free = _disk.FreeBytes();
    }
    if (free && *free < margin)
    {
        _status.Problem = "only " + Mebibytes(*free) + " MiB are free in " + _settings.Record.Folder +
                          ", and " + Mebibytes(Margin()) + " are to stay free; move earlier recordings away";
        return false;
    }
    return true;
}

void RecordingFiles::WriteLosses()
{
    if (!std::exchange(_lossesChanged, false))
    {
        return;
    }
    Mcap::Metadata losses;
    losses.Name = "rabit.losses";
    for (const auto &[topic, count] : _status.Lost)
    {
        losses.Values[topic] = std::to_string(count);
    }
    _writer->AddMetadata(losses);
}

void RecordingFiles::Lose(Stream &stream, std::uint64_t count)
{
    if (count > 0)
    {
        _status.Lost[stream.Info->Topic] += count;
        _lossesChanged = true;
    }
}

}  // namespace Rabit
