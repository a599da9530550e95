#pragma once

#include <rabit/mcap/McapWriter.h>
#include <rabit/mcap/MessageCursor.h>

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "recording/merge/MergePlan.h"
#include "recording/merge/MergedChannels.h"

namespace Rabit::Merge
{

// The result of a merge.
struct Merged
{
    std::vector<std::uint64_t> Messages;  // by life
    std::uint64_t TimeLines = 0;          // of the topics `<node>/Recorder/TimeLine`, which no recording has
    std::uint64_t Repeated = 0;  // states that files of a recording repeat at their beginning, left out
    std::uint64_t Lost = 0;      // without a channel, or too large
    std::vector<std::string> Problems;  // what could not be read, one line each
    bool WasStopped = false;
    bool IsWritten = false;  // whether the file is whole
};

// Writes the messages of all lives into one file, in the order of the time line, and ends it. Reads files
// as it comes to them, a few chunks at a time. Beside the messages it writes
//   <node>/Recorder/TimeLine   every ten seconds, how a life is put on the time line, and the bound of the
//                              error
//   metadata rabit.merge       which clock is the time line, and the worst bound
//   metadata rabit.recording   for each life: its node, times, files, way to the time line, bounds
//   metadata rabit.configuration, rabit.not_recorded   of each life, with `node` and `life`
//   metadata rabit.losses      of all, by topic
// Times within clock reports and log lines are put on the time line, too.
class Merger
{
public:
    // The arguments must outlive the object.
    Merger(const OpenFile &open, const Lives &lives, const MergePlan &plan, Mcap::McapWriter &writer);
    ~Merger();

    // To be called once. `stops` is called now and then; true ends the merge early.
    Merged Run(const std::function<bool()> &stops);

private:
    struct Stream;
    struct Later
    {
        bool operator()(const std::unique_ptr<Stream> &left, const std::unique_ptr<Stream> &right) const;
    };

    void Open();
    void Advance(std::unique_ptr<Stream> stream);
    void Write(Stream &stream);
    bool IsRepeated(const Stream &stream, std::uint16_t channel);
    Mcap::Bytes OnTimeLine(const Stream &stream, MergedChannels::Inside inside) const;
    void TellTimeLine(std::size_t life, Moment at, Moment logTime);
    void WriteMetadata();
    void WriteLife(std::size_t life, std::map<std::string, std::uint64_t> &lost);
    void WriteCopy(std::size_t life, const std::string &name);

    const OpenFile &_open;
    const Lives &_lives;
    const MergePlan &_plan;
    Mcap::McapWriter &_writer;
    MergedChannels _channels;
    Merged _merged;
    std::vector<std::unique_ptr<Stream>> _waiting;  // files that are not open yet, the last one first
    std::vector<std::unique_ptr<Stream>> _streams;  // that are open: a heap, the earliest first
    std::vector<Moment> _tellAt;                    // by life
    std::map<std::uint16_t, std::uint64_t> _lastPublishTime;  // by channel
};

}  // namespace Rabit::Merge
