#include "recording/merge/Lives.h"

#include <rabit/base/NaturalOrder.h>
#include <rabit/base/NumberIn.h>
#include <rabit/mcap/MessageCursor.h>

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

#include "recording/merge/ChannelChunks.h"

namespace Rabit::Merge
{
namespace
{

// A file, and the node that recorded it.
struct Found
{
    LifeFile File;
    std::string Node;
    std::string Host;
    std::string Recording;                     // empty: it does not say
    std::optional<std::uint64_t> Incarnation;  // empty: nothing tells it
};

class Reader
{
public:
    explicit Reader(const OpenFile &open) : _open(open) {}

    Lives Run(const std::vector<std::string> &paths)
    {
        for (const std::string &path : paths)
        {
            Find(path);
            if (!_lives.Problem.empty())
            {
                return std::move(_lives);
            }
        }
        PassOverTwins();
        Sort();
        FindIncarnations();
        for (Found &found : _found)
        {
            Take(std::move(found));
        }
        _lives.Graph.Finish();
        std::stable_sort(_lives.All.begin(), _lives.All.end(),
                         [](const Life &one, const Life &other)
                         { return std::pair(one.Node, one.Begin) < std::pair(other.Node, other.Begin); });
        if (_lives.All.empty() && _lives.Problem.empty())
        {
            _lives.Problem = "there is no message in any of them";
        }
        return std::move(_lives);
    }

private:
    void Find(const std::string &path)
    {
        const auto source = _open(path);
        Found found;
        found.File.Path = path;
        found.File.Contents = Mcap::ReadContents(*source);
        const Mcap::Contents &contents = found.File.Contents;
        for (const std::string &problem : contents.Problems)
        {
            _lives.Remarks.push_back(path + ": " + problem);
        }
        if (!MetadataOf(contents, "rabit.merge").empty())
        {
            _lives.Problem = path + ": is merged already";
            return;
        }
        if (contents.Statistics.MessageCount == 0)
        {
            _lives.Remarks.push_back(path + ": there is no message in it");
            return;
        }
        const Mcap::TextMap node = MetadataOf(contents, "rabit.node");
        found.Node = Mcap::ValueOf(node, "node");
        found.Host = Mcap::ValueOf(node, "host");
        found.Recording = Mcap::ValueOf(MetadataOf(contents, "rabit.file"), "recording");
        if (found.Node.empty())
        {
            _lives.Problem = path + ": does not say which node recorded it";
            return;
        }
        found.File.Number =
            NumberIn<std::uint64_t>(Mcap::ValueOf(MetadataOf(contents, "rabit.file"), "number")).value_or(0);
        found.File.Begin = FromFile(contents.Statistics.StartTime);
        found.File.End = FromFile(contents.Statistics.EndTime);
        _found.push_back(std::move(found));
    }

    static bool AreTwins(const Found &one, const Found &other)
    {
        return one.Node == other.Node && one.File.Number == other.File.Number &&
               one.File.Begin == other.File.Begin && one.Recording == other.Recording;
    }

    void PassOverTwins()
    {
        std::vector<Found> once;
        for (Found &found : _found)
        {
            const auto twin = std::find_if(once.begin(), once.end(),
                                           [&found](const Found &one) { return AreTwins(one, found); });
            if (twin == once.end())
            {
                once.push_back(std::move(found));
                continue;
            }
            if (twin->File.Contents.Statistics.MessageCount < found.File.Contents.Statistics.MessageCount)
            {
                std::swap(*twin, found);
            }
            _lives.Remarks.push_back(found.File.Path + ": is passed over, since " + twin->File.Path +
                                     " is the same");
        }
        _found = std::move(once);
    }

    void Sort()
    {
        std::stable_sort(_found.begin(), _found.end(),
                         [](const Found &one, const Found &other)
                         {
                             return one.Node != other.Node
                                        ? NaturalOrder()(one.Node, other.Node)
                                        : std::tie(one.Recording, one.File.Number, one.File.Begin) <
                                              std::tie(other.Recording, other.File.Number, other.File.Begin);
                         });
    }

    // Calls take(log time, report) for each report, until it returns false.
    template <typename Take>
    void ReadClocks(const Found &found, Take take)
    {
        const std::string topic = found.Node + "/Recorder/Clocks";
        const auto source = _open(found.File.Path);
        const ChannelChunks chunks(found.File.Contents,
                                   [&topic](const Mcap::Channel &channel) { return channel.Topic == topic; });
        Mcap::MessageCursor cursor(*source, chunks.Contents(), chunks.Selection());
        bool goesOn = true;
        while (goesOn)
        {
            const auto message = cursor.Next();
            if (!message)
            {
                break;
            }
            if (const auto report = ReadClockReport(message->Data))
            {
                goesOn = take(FromFile(message->LogTime), *report);
            }
        }
    }

    // A very short file may hold no report: then it has the incarnation of its neighbours in the same
    // recording.
    void FindIncarnations()
    {
        for (Found &found : _found)
        {
            ReadClocks(found,
                       [&found](Moment, const ClockReport &report)
                       {
                           found.Incarnation = report.Incarnation;
                           return false;
                       });
        }
        for (std::size_t i = 1; i < _found.size(); ++i)
        {
            TakeOver(_found[i - 1], _found[i]);
        }
        for (std::size_t i = _found.size(); i-- > 1;)
        {
            TakeOver(_found[i], _found[i - 1]);
        }
    }

    static void TakeOver(const Found &from, Found &to)
    {
        if (!to.Incarnation && !to.Recording.empty() && from.Node == to.Node &&
            from.Recording == to.Recording)
        {
            to.Incarnation = from.Incarnation;
        }
    }

    void Take(Found found)
    {
        const bool isAlone = !found.Incarnation && found.Recording.empty();
        const std::string key = found.Node + "\n" + found.Recording + "\n" +
                                (isAlone ? found.File.Path : std::to_string(found.Incarnation.value_or(0)));
        const auto [known, isNew] = _byKey.try_emplace(key, _lives.All.size());
        if (isNew)
        {
            _lives.All.push_back({found.Node, found.Host, {}, found.File.Begin, found.File.End, {}, 0, 0});
        }
        Life &life = _lives.All[known->second];
        life.Begin = std::min(life.Begin, found.File.Begin);
        life.End = std::max(life.End, found.File.End);
        ReadClocks(found,
                   [this, &life](Moment logTime, const ClockReport &report)
                   {
                       if (!life.Clock)
                       {
                           life.Clock = _lives.Graph.Of(life.Node, report.Incarnation);
                           life.Incarnation = report.Incarnation;
                           life.SourceToLog = report.SourceToLog;
                       }
                       if (report.Incarnation == life.Incarnation)
                       {
                           _lives.Graph.Add(*life.Clock, logTime, report);
                       }
                       return true;
                   });
        life.Files.push_back(std::move(found.File));
    }

    const OpenFile &_open;
    std::vector<Found> _found;
    std::map<std::string, std::size_t> _byKey;
    Lives _lives;
};

}  // namespace

Lives ReadLives(const OpenFile &open, const std::vector<std::string> &paths)
{
    return Reader(open).Run(paths);
}

}  // namespace Rabit::Merge
