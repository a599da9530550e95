#include <rabit/backfill/BackfillManager.h>
#include <rabit/gateway/Fleet.h>
#include <rabit/gateway/GatewayManager.h>
#include <rabit/gateway/NamePattern.h>
#include <rabit/gateway/RandomSource.h>
#include <rabit/recording/RecorderManager.h>

#include <algorithm>
#include <chrono>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "backfill/AnswerTo.h"
#include "backfill/FileAnswers.h"
#include "backfill/FolderPosts.h"
#include "backfill/Mail.h"
#include "backfill/Outbox.h"
#include "backfill/PostAccess.h"
#include "backfill/PostAnswers.h"
#include "backfill/QuestionQueue.h"
#include "backfill/ReadLedger.h"
#include "backfill/RecordingWatch.h"
#include "backfill/Requester.h"
#include "backfill/SeriesStreams.h"
#include "recording/RecordingTarget.h"

namespace Rabit
{
namespace
{

using namespace Backfill;

constexpr double LookPeriod = 0.1;  // seconds
// Until recordings that could not be read are read again.
constexpr std::chrono::seconds ReadPeriod(1);
// Answers under way to one node. A restart of either end costs these at most.
constexpr std::size_t MostAnswers = 4;

bool Answers(const GatewayConfig &config)
{
    return config.Record && !config.Record->BlackBox && !config.Publish.empty();
}

}  // namespace

class BackfillManager::Parts
{
public:
    Parts(GatewayConfig &config, RecorderManager *recorder, BackfillManager &manager)
        : _manager(manager),
          _target(recorder != nullptr ? recorder->Target() : nullptr),
          _mail(Mail::For(config)),
          _config(Copy(config)),
          _outbox(manager.GetWorkspace(), manager.WakeUpHandler()),
          _fleet(std::make_shared<Gateway::Fleet>()),
          _files(config.Fetch ? config.Fetch->Folder : "",
                 [this](const std::string &node) { return MatchesAny(_config.Fetch->From, node); })
    {
        if (Answers(config) && _target)
        {
            _posts = std::make_unique<FolderPosts>(config.Record->Folder, config.Node);
            _answers = std::make_unique<PostAnswers>(
                *_posts,
                [this](const std::string &node, const std::string &)
                { return MayRequestPosts(_config, node); },
                [this](const std::string &message) { return Offers(message); });
        }
        if (config.Record && !config.Record->Backfill.empty() && _target)
        {
            const auto last = std::chrono::duration_cast<std::chrono::seconds>(config.Record->BackfillLast);
            _streams = std::make_shared<SeriesStreams>(config, _target, _ledger);
            _target->TakeOver(config.Record->Backfill);
            _requester = std::make_unique<Requester>(*_ledger, last, SystemRandom());
            _mail->OnMirrored = [streams = _streams](const GatewayTap::MirroredSample &sample)
            { streams->TakeLive(sample); };
            // The gateway may live longer than this object.
            _mail->OwnProblems = [told = _told]
            {
                const std::lock_guard lock(told->Mutex);
                return told->Problems;
            };
        }
    }

    void Start()
    {
        static_cast<void>(
            _manager.AddPublishSubscribeMessage(FleetMessageNameOf(_config), _fleet));  // the gateway says so
        _isLedgerRead = _requester && ReadRecordings();
    }

    void Work()
    {
        const Duration now = _manager.GetWorkspace().GetClock().Monotonic();
        if (_requester)
        {
            LookAtDisk(now);
        }
        const auto queue = _manager.GetManagerMessageQueue();
        for (std::shared_ptr<RabitMessage> message; queue->GetMessage(message);)
        {
            message.reset();  // the same came with its sender's name
        }
        for (const auto &[node, question] : _outbox.TakeFailed())
        {
            if (_requester)
            {
                _requester->Failed(node, question, now);
            }
        }
        if (_fleet->FetchMessage())
        {
            TakeFleet(now);
        }
        for (Mail::Letter &letter : _mail->Take())
        {
            // Answers leave out the posts that this node had when it asked. While the disk fails these may be
            // lost: the answers are dropped, and requested anew.
            if (letter.Answered && _requester && !_isPaused)
            {
                TakeAnswer(letter.Node, *letter.Answered, now);
            }
            else if (letter.Asked)
            {
                if (!_config.Record || !MayRequestPosts(_config, letter.Node))
                {
                    letter.Asked->had.clear();  // all that it gets is a refusal
                }
                static_cast<void>(_questions.Add(letter.Node, std::move(*letter.Asked)));
            }
        }
        AnswerQuestions(now);
        if (_requester && !_isPaused)
        {
            for (const Requester::Asking &asking : _requester->Due(now))
            {
                if (!_outbox.Send(asking.Node, asking.What))
                {
                    _requester->Failed(asking.Node, asking.What, now);
                }
            }
        }
    }

private:
    using Duration = std::chrono::nanoseconds;

    // For Gateway/Fleet.
    struct Told
    {
        std::mutex Mutex;
        std::vector<Gateway::Problem> Problems;  // guarded
    };

    static GatewayConfig Copy(GatewayConfig config)
    {
        config.Tap.reset();
        return config;
    }

    bool Offers(const std::string &message) const
    {
        const RecordSettings &record = *_config.Record;
        return MatchesAny(record.Messages, message) && !MatchesAny(record.Except, message) &&
               std::any_of(_config.Publish.begin(), _config.Publish.end(),
                           [&message](const PublishRule &rule) { return rule.Message == message; });
    }
    // Nothing is requested that could not be recorded. When the disk has failed nobody knows which posts are
    // on it: once it works again, the ledger is read from the recordings anew. Until then no post that can
    // come later goes to the recorder, so that these are complete.
    void LookAtDisk(Duration now)
    {
        const RecordingWatch::State state = _watch.Look(_target->Status(), now);
        const bool works = state != RecordingWatch::State::Fails;
        _isLedgerRead = _isLedgerRead && state != RecordingWatch::State::WorksAgain;
        if (works && !_isLedgerRead && now >= _readNotBefore)
        {
            _ledger->Clear();
            _isLedgerRead = ReadRecordings();
            _readNotBefore = now + ReadPeriod;
            if (_isLedgerRead)
            {
                _requester->StartOver(now);
            }
        }
        _isPaused = !works || !_isLedgerRead;
        if (_isPaused)
        {
            _streams->SetLiveOnly(_requester->LiveOnly());
        }
        _streams->SetPaused(_isPaused);
    }
    // False: they cannot be read now.
    bool ReadRecordings()
    {
        const auto last =
            static_cast<std::uint64_t>(std::chrono::nanoseconds(_config.Record->BackfillLast).count());
        const std::uint64_t now = _target->Now();
        return ReadLedger(_config.Record->Folder, _config.Node, now - std::min(now, last), *_ledger);
    }

    void TakeFleet(Duration now)
    {
        for (const Gateway::NodeStatus &node : _fleet->nodes)
        {
            const std::vector<std::string> messages = MessagesOf(node.node);
            if (_requester && !messages.empty())
            {
                _requester->SetNode(node.node, node.incarnation, node.state == Gateway::NodeState::UP,
                                    messages, now);
            }
        }
        TellProblems();
    }
    std::vector<std::string> MessagesOf(const std::string &node) const
    {
        std::vector<std::string> messages;
        for (const SubscribeRule &rule : _config.Subscribe)
        {
            if (_streams && _streams->IsBackfilled(rule.Message) && MatchesAny(rule.From, node))
            {
                messages.push_back(rule.Message);
            }
        }
        return messages;
    }
    void TellProblems()
    {
        std::vector<Gateway::Problem> problems;
        if (_requester)
        {
            for (const auto &[name, reason] : _requester->Refusals())
            {
                problems.push_back({"backfill " + name.second, name.first, reason});
            }
            if (_isPaused)
            {
                problems.push_back({"backfill", "",
                                    _isLedgerRead ? "nothing is requested, since nothing can be recorded"
                                                  : "nothing is requested, since the recordings of this node "
                                                    "cannot be read"});
            }
            if (const std::uint64_t count = _streams->Incredible(); count > 0)
            {
                problems.push_back({"backfill", "",
                                    std::to_string(count) +
                                        " posts were not recorded, since their times are " +
                                        "not credible; compare the clocks of the nodes"});
            }
            if (const std::uint64_t count = _streams->TooLarge(); count > 0)
            {
                problems.push_back(
                    {"backfill", "",
                     std::to_string(count) +
                         " posts were not recorded, since they are larger than three fourths of " +
                         "`record: memory`"});
            }
        }
        const std::lock_guard lock(_told->Mutex);
        _told->Problems = std::move(problems);
    }

    void TakeAnswer(const std::string &node, const Answer &answer, Duration now)
    {
        const auto whole = _requester->Answered(
            node, answer,
            [this](const Series &series, const Post &post)
            {
                // By its own wall clock, if this node has never heard it.
                const auto toLocal = _mail->SourceToLocal(series.Node, series.Incarnation);
                return _streams->TakeMissed(series, post, toLocal.value_or(-_target->MonotonicToLog()));
            },
            now);
        if (whole)
        {
            _streams->TakeWhole(whole->first, whole->second);
        }
    }

    void AnswerQuestions(Duration now)
    {
        _files.BeginTurn();
        _questions.Answer(now,
                          [this](const std::string &node, const Question &question)
                          {
                              if (_outbox.Answers(node) >= MostAnswers)
                              {
                                  return QuestionQueue::Outcome::Later;
                              }
                              std::optional<Answer> answer = AnswerTo(node, question);
                              if (!answer)
                              {
                                  return QuestionQueue::Outcome::Later;
                              }
                              return _outbox.Send(node, *answer) ? QuestionQueue::Outcome::Answered
                                                                 : QuestionQueue::Outcome::Refused;
                          });
    }
    // Empty: not yet.
    std::optional<Answer> AnswerTo(const std::string &node, const Question &question)
    {
        if (question.kind == Kind::FACTS || question.kind == Kind::PART)
        {
            return _files.Of(node, question);
        }
        if (_answers)
        {
            _posts->SetPresent(_mail->Incarnation(), _target->Now());
            return _answers->Of(node, question);
        }
        Answer answer = Backfill::AnswerTo(question);
        answer.incarnation = question.incarnation;
        answer.result = Result::UNKNOWN;
        return answer;
    }

    BackfillManager &_manager;
    const std::shared_ptr<RecordingTarget> _target;  // null: this node does not record
    const std::shared_ptr<Mail> _mail;
    const GatewayConfig _config;
    Outbox _outbox;
    std::shared_ptr<Gateway::Fleet> _fleet;
    FileAnswers _files;
    std::unique_ptr<FolderPosts> _posts;    // null: no posts are sent
    std::unique_ptr<PostAnswers> _answers;  // likewise
    const std::shared_ptr<Ledger> _ledger = std::make_shared<Ledger>();
    std::shared_ptr<SeriesStreams> _streams;  // null: nothing is requested
    std::unique_ptr<Requester> _requester;    // likewise
    QuestionQueue _questions;
    RecordingWatch _watch;
    bool _isLedgerRead = false;  // it has what is in the recordings
    Duration _readNotBefore{0};
    bool _isPaused = false;  // the disk failed, or the recordings cannot be read
    const std::shared_ptr<Told> _told = std::make_shared<Told>();
};

bool BackfillManager::IsUsed(const GatewayConfig &config)
{
    return config.Fetch || Answers(config) || (config.Record && !config.Record->Backfill.empty());
}

BackfillManager::BackfillManager(GatewayConfig &config, RecorderManager *recorder)
    : BackfillManager(config, recorder, *RabitWorkspace::GetWorkspace())
{
}

BackfillManager::BackfillManager(GatewayConfig &config, RecorderManager *recorder, RabitWorkspace &workspace)
    : RabitManager(QueueName, workspace, QueueCapacity),
      _parts(std::make_unique<Parts>(config, recorder, *this))
{
    SetWakeupTimeDelaySec(LookPeriod);
}

BackfillManager::~BackfillManager() = default;

void BackfillManager::Startup()
{
    _parts->Start();
}

void BackfillManager::ExecuteUnitOfWork()
{
    _parts->Work();
}

}  // namespace Rabit
