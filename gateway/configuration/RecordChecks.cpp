#include <rabit/idl/NearestWord.h>

#include <algorithm>
#include <utility>

#include "configuration/ConfigCheck.h"

namespace Rabit
{
namespace
{

class RecordChecks : ConfigCheck
{
public:
    using ConfigCheck::ConfigCheck;

    void Run() const
    {
        CheckRecord();
        CheckFetch();
    }

private:
    void CheckRecord() const
    {
        if (!_config.Record)
        {
            return;
        }
        const RecordSettings &record = *_config.Record;
        if (record.Folder.empty())
        {
            Fail(LineOf("record.folder"), "no folder for recordings; expected `folder: <path>`");
        }
        if (record.SplitTime < std::chrono::seconds(1) || record.SplitTime > std::chrono::hours(24))
        {
            Fail(LineOf("record.split_time"), "`split_time` is out of range; expected 1s to 1440min");
        }
        CheckMessagePatterns(record.Messages, "messages", LineOf("record.messages"));
        CheckMessagePatterns(record.Except, "except", LineOf("record.except"));
        CheckMessagePatterns(record.Steps, "steps", LineOf("record.steps"), "name of a manager");
        if (record.BlackBox)
        {
            CheckBlackBox(*record.BlackBox);
        }
        CheckBackfill(record);
    }

    void CheckBackfill(const RecordSettings &record) const
    {
        const int line = LineOf("record.backfill");
        for (const std::string &message : record.Backfill)
        {
            if (std::none_of(_config.Subscribe.begin(), _config.Subscribe.end(),
                             [&message](const SubscribeRule &rule) { return rule.Message == message; }))
            {
                std::vector<std::string> names;
                for (const SubscribeRule &rule : _config.Subscribe)
                {
                    names.push_back(rule.Message);
                }
                Fail(line, "`backfill` names `" + message + "`, which no `subscribe` entry names" +
                               NearestWordHint(message, names));
            }
        }
        CheckNoneTwice(record.Backfill, "backfill", line);
        if (!record.Backfill.empty() && record.BlackBox)
        {
            Fail(line,
                 "`backfill` needs a recording of everything, and `black_box` drops most of it; remove "
                 "one of them");
        }
        if (record.BackfillLast < std::chrono::seconds(1) || record.BackfillLast > std::chrono::hours(24))
        {
            Fail(LineOf("record.backfill_last"), "`backfill_last` is out of range; expected 1s to 1440min");
        }
        if (record.BackfillTo && !record.BackfillTo->empty())
        {
            CheckPatterns(*record.BackfillTo, "backfill_to", LineOf("record.backfill_to"));
        }
    }

    void CheckBlackBox(const BlackBoxSettings &box) const
    {
        for (const auto &[key, time] : {std::pair("before", box.Before), std::pair("after", box.After)})
        {
            if (time < std::chrono::seconds(1) || time > std::chrono::hours(1))
            {
                Fail(LineOf(std::string("record.black_box.") + key),
                     std::string("`") + key + "` is out of range; expected 1s to 60min");
            }
        }
        CheckMessagePatterns(box.Messages, "messages", LineOf("record.black_box.messages"));
        CheckMessagePatterns(box.Queues, "queues", LineOf("record.black_box.queues"));
    }

    void CheckFetch() const
    {
        if (!_config.Fetch)
        {
            return;
        }
        if (_config.Fetch->Folder.empty())
        {
            Fail(LineOf("fetch.folder"), "no folder of files to fetch; expected `folder: <path>`");
        }
        if (_config.Fetch->From.empty())
        {
            Fail(LineOf("fetch.from"), "nobody may fetch; expected `from: [<node>]`");
        }
        CheckPatterns(_config.Fetch->From, "from", LineOf("fetch.from"));
    }
};

}  // namespace

void CheckRecording(const GatewayConfig &config, const TypeCheck &whyNoType)
{
    RecordChecks(config, whyNoType).Run();
}

}  // namespace Rabit
