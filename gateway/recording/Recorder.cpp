#include "recording/Recorder.h"

#include <rabit/RabitLog.h>

#include <chrono>
#include <exception>
#include <string>
#include <utility>

namespace Rabit
{
namespace
{

// With RecordingFiles::FlushPeriod (400 ms), items are on the disk after half a second.
constexpr std::chrono::milliseconds Turn(100);

}  // namespace

Recorder::Recorder(std::unique_ptr<RecordingDisk> disk, const RecordingSettings &settings, Clock clock)
    : _clock(std::move(clock)),
      _disk(std::move(disk)),
      _inbox(settings.Record.Memory),
      _files(*_disk, settings),
      _blackBox(settings.Record.BlackBox
                    ? std::make_optional<BlackBox>(settings.Record.BlackBox->Before,
                                                   settings.Record.BlackBox->After, settings.Record.Memory)
                    : std::nullopt),
      _thread([this] { Run(); })
{
}

Recorder::~Recorder()
{
    End();
}

void Recorder::End()
{
    _inbox.Close();
    if (_thread.joinable())
    {
        _thread.join();
    }
}

RecordingStatus Recorder::Status() const
{
    const std::lock_guard lock(_mutex);
    return _status;
}

void Recorder::Run()
{
    RecordingInbox::Batch batch;
    do
    {
        _inbox.Take(batch, Turn);
        Write(batch);
        _inbox.Done(batch);
        for (const std::string &removal : _files.TakeRemovals())
        {
            RabitLog::Write(RabitLogLevel::Warning, "recording: " + removal);
        }
        const std::lock_guard lock(_mutex);
        _status = _files.Status();
    } while (!batch.IsEnd);
}

// Catches exceptions: a recording that fails does not end the process.
void Recorder::Write(RecordingInbox::Batch &batch)
{
    try
    {
        const bool wasOpen = _blackBox && _blackBox->IsOpen();
        if (_blackBox)
        {
            _blackBox->Take(batch, _clock());
            _files.Remember(batch, _blackBox->LetGo());
        }
        const bool ends = _blackBox && !_blackBox->IsOpen() && (wasOpen || !batch.Items.empty());
        _files.Take(batch, _clock());
        if (ends)
        {
            _files.Close(_clock());
        }
        _files.Service(_clock());
        if (batch.IsEnd)
        {
            _files.Close(_clock());
        }
    }
    catch (const std::exception &error)
    {
        _files.Abandon(error.what(), _clock());
    }
}

}  // namespace Rabit
