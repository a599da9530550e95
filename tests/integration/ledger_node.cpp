// A node that writes a line for each event that it causes or sees, for judge.py. README.md lists the lines.
// Each line is one write(2), so a kill loses at most the line being written.
#include "LedgerFile.h"
#include "Orders.h"
#include "Padding.h"
#include "PictureClerk.h"
#include "StateClerk.h"
#include "TestNode.h"
#include "gateway.idl.h"
#include "ledger.idl.h"

#include <rabit/RabitManager.h>
#include <rabit/gateway/GatewayManager.h>

#include <CLI/CLI.hpp>

#include <chrono>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace
{
using TestNode::LedgerFile;
using TestNode::Now;

constexpr const char *NotesQueue = "Notes";
constexpr int WorkPeriodMSec = 10;
constexpr std::int64_t CountersPeriodNs = 200'000'000;

struct Options
{
    Rabit::GatewayConfig Gateway;
    std::string LedgerFile;
    std::vector<std::string> To;
    std::vector<std::string> AcceptFrom = {"*"};
    std::uint64_t Count = 0;
    double Rate = 100;
    std::size_t Payload = 100;
    std::size_t Capacity = 1000;
    std::size_t Window = 128;
    int QueueRoom = 100;
    double ExpireS = 0;
    bool HeldNotes = false;
    double DrainPeriodS = 0;
    std::int64_t Life = 0;
    bool Ticks = false;
    std::int64_t TickPeriodNs = 100'000'000;
    std::size_t TickPayload = 0;
    bool HeldTicks = false;
    TestNode::PictureOptions Pictures;
    bool TakesPictures = false;
    TestNode::StateOptions States;
    bool TakesOrders = false;
    TestNode::Orders Orders;
};

// Sends notes, takes notes, and follows the ticks and the fleet.
class Clerk : public Rabit::RabitManager
{
public:
    explicit Clerk(Options &options)
        : RabitManager("Clerk"),
          _options(options),
          _ledger(options.LedgerFile),
          _life(options.Life),
          _notes(std::make_shared<RabitQueue>(options.QueueRoom, NotesQueue))
    {
        AddManagerMessageQueue(NotesQueue, _notes);
        WakeUpManagerOnEnqueue(_notes);
        AddPublishSubscribeMessage(Rabit::FleetMessageName, _fleet);
        if (options.Ticks)
        {
            AddPublishSubscribeMessage("Tick", _tick);
            _tick->padding.assign(options.TickPayload, 0x5a);
        }
        SetWakeupTimeDelayMSec(WorkPeriodMSec);
        // Before any manager runs: other managers write lines of this life, too.
        std::ostringstream line;
        line << "start node=" << _options.Gateway.Node << " life=" << _life
             << " room=" << _options.QueueRoom + static_cast<int>(_options.Window);
        _ledger.Line(line.str());
    }

    void ExecuteUnitOfWork() override
    {
        if (_fleet->FetchMessage())
            FollowFleet();
        if (_options.TakesOrders)
            _options.Orders.Read();
        Send();
        FollowReceipts();
        Take();
        PostTick();
        FollowTicks();
    }

    void Shutdown() override
    {
        _nextDrain = 0;
        Take();
        FollowReceipts();
        _fleet->FetchMessage();
        WriteCounters();
        _ledger.Line("end");
    }

private:
    struct Row
    {
        std::int64_t Start = 0;
        std::uint64_t Sent = 0;  // accepted
        std::uint64_t LastId = 0;
        // The receipts of accepted notes whose outcome is not in the ledger yet, with their ids.
        std::deque<std::pair<std::uint64_t, std::shared_ptr<Rabit::RabitQueueReceipt>>> Receipts;
    };

    void Send()
    {
        for (const std::string &to : _options.To)
        {
            if (!_ready.count(to))
                continue;
            Row &row = _rows[to];
            if (row.Start == 0)
                row.Start = Now();
            const double due = static_cast<double>(Now() - row.Start) * 1e-9 * _options.Rate;
            while (row.Sent < _options.Count + _options.Orders.Notes() && static_cast<double>(row.Sent) < due)
                if (!SendOne(to, row))
                    break;
        }
    }

    // Writes the intent first, so that each arriving note has one. If the process is killed between the two
    // lines, the fate of this one note is unknown.
    bool SendOne(const std::string &to, Row &row);

    // A link settles its messages from the front, so only the first receipts need a look.
    void FollowReceipts()
    {
        for (auto &[to, row] : _rows)
        {
            while (!row.Receipts.empty())
            {
                const auto &[id, receipt] = row.Receipts.front();
                const Rabit::QueueOutcome outcome = receipt->Outcome();
                if (outcome == Rabit::QueueOutcome::Pending)
                {
                    break;
                }
                std::ostringstream line;
                line << "outcome to=" << to << " id=" << id << " is=\"" << Rabit::ToString(outcome) << '"';
                _ledger.Line(line.str());
                row.Receipts.pop_front();
            }
        }
    }

    void Take()
    {
        if ((_options.HeldNotes && !_options.Orders.MayTake()) || Now() < _nextDrain)
            return;
        _nextDrain = Now() + static_cast<std::int64_t>(_options.DrainPeriodS * 1e9);
        std::shared_ptr<Rabit::RabitMessage> message;
        while (_notes->GetMessage(message))
        {
            std::ostringstream line;
            const auto *note = dynamic_cast<const Ledger::Note *>(message.get());
            if (note == nullptr || !TestNode::IsPadding(note->padding, note->id))
                line << "garbled";
            else
                line << "delivered from=" << note->from << " life=" << note->life << " id=" << note->id
                     << " octets=" << note->padding.size() << (note->IsRedelivered() ? " redelivered=1" : "");
            _ledger.Line(line.str());
        }
    }

    void PostTick()
    {
        if (!_options.Ticks || Now() < _nextTick)
            return;
        _nextTick = Now() + _options.TickPeriodNs;
        ++_tick->number;
        _tick->PostMessage();
    }

    void FollowTicks()
    {
        for (auto &[node, tick] : _ticks)
        {
            if (!tick->FetchMessage())
                continue;
            std::ostringstream line;
            line << "tick from=" << node << " number=" << tick->number << " age_s=" << tick->GetAgeSeconds();
            _ledger.Line(line.str());
        }
    }

    void FollowFleet()
    {
        for (const auto &status : _fleet->nodes)
        {
            const auto known = _states.find(status.node);
            if (known != _states.end() && known->second == status.state)
                continue;
            _states[status.node] = status.state;
            const char *name = status.state == Rabit::Gateway::NodeState::UP      ? "UP"
                               : status.state == Rabit::Gateway::NodeState::STALE ? "STALE"
                                                                                  : "LOST";
            std::ostringstream line;
            line << "peer node=" << status.node << " state=" << name << " heard_s=" << status.last_heard_s;
            _ledger.Line(line.str());
            // A message to a node that is not known yet is refused, which is right but of no use here.
            if (status.state == Rabit::Gateway::NodeState::UP)
                _ready.insert(status.node);
            if (_options.Ticks && !_ticks.count(status.node))
            {
                _ticks[status.node] = std::make_shared<Ledger::Tick>();
                AddPublishSubscribeMessage(status.node + "/Tick", _ticks[status.node]);
                if (_options.HeldTicks)
                {
                    _ticks[status.node]->Register_SomethingPublished([this]
                                                                     { _options.Orders.AwaitReturn(); });
                }
            }
        }
        for (const auto &problem : _fleet->problems)
            if (_problems.insert(problem.subject + problem.node + problem.reason).second)
                _ledger.Line("problem node=" + problem.node + " subject=\"" + problem.subject +
                             "\" reason=\"" + problem.reason + '"');
        for (const auto &topic : _fleet->topics)
            WriteOnChange("topic message=" + topic.message + " from=" + topic.node,
                          " undecodable=" + std::to_string(topic.undecodable) +
                              " refused=" + std::to_string(topic.refused));
        WriteOnChange("malformed", " count=" + std::to_string(_fleet->malformed));
        if (Now() >= _nextCounters)
            WriteCounters();
    }

    void WriteOnChange(const std::string &subject, const std::string &values)
    {
        if (_written[subject] != values)
            _ledger.Line(subject + (_written[subject] = values));
    }

    void WriteCounters()
    {
        _nextCounters = Now() + CountersPeriodNs;
        for (const auto &link : _fleet->links)
        {
            std::ostringstream line;
            line << " accepted=" << link.accepted << " delivered=" << link.delivered
                 << " expired=" << link.expired << " in_doubt=" << link.in_doubt
                 << " undeliverable=" << link.undeliverable << " outbox=" << link.outbox
                 << " resent=" << link.resent;
            const std::string queue = link.queue == NotesQueue ? "" : " queue=" + link.queue;
            WriteOnChange("link to=" + link.node + queue, line.str());
        }
    }

    Options &_options;
    LedgerFile _ledger;
    std::int64_t _life;
    std::shared_ptr<RabitQueue> _notes;
    std::shared_ptr<Rabit::Gateway::Fleet> _fleet = std::make_shared<Rabit::Gateway::Fleet>();
    std::shared_ptr<Ledger::Tick> _tick = std::make_shared<Ledger::Tick>();
    std::map<std::string, std::shared_ptr<Ledger::Tick>> _ticks;
    std::map<std::string, Rabit::Gateway::NodeState> _states;
    std::map<std::string, std::string> _written;
    std::set<std::string> _ready;
    std::set<std::string> _problems;
    std::map<std::string, Row> _rows;
    std::int64_t _nextTick = 0;
    std::int64_t _nextCounters = 0;
    std::int64_t _nextDrain = 0;
};

bool Clerk::SendOne(const std::string &to, Row &row)
{
    auto note = std::make_shared<Ledger::Note>();
    note->from = _options.Gateway.Node;
    note->life = static_cast<std::uint64_t>(_life);
    note->id = ++row.LastId;
    note->padding = TestNode::Padding(note->id, _options.Payload);
    std::ostringstream rest;
    rest << " to=" << to << " id=" << note->id;
    std::ostringstream more;
    more << " expire_s=" << _options.ExpireS << " octets=" << _options.Payload;
    _ledger.Line("intent" + rest.str() + more.str());
    const auto receipt = std::make_shared<Rabit::RabitQueueReceipt>();
    const bool accepted = AddMessageToQueue(to + '/' + NotesQueue, note, receipt);
    _ledger.Line((accepted ? "accepted" : "refused") + rest.str());
    if (accepted)
    {
        ++row.Sent;
        row.Receipts.emplace_back(note->id, receipt);
    }
    return accepted;
}

void Describe(CLI::App &app, Options &o)
{
    TestNode::DescribeNetwork(app, o.Gateway);
    app.add_option("--ledger", o.LedgerFile, "File to which the lines are appended")->required();
    app.add_option("--state-dir", o.Gateway.StateDir);
    app.add_option("--to", o.To, "Node to send notes to");
    app.add_option("--count", o.Count, "Notes to have accepted by each of these nodes' links");
    app.add_flag("--orders", o.TakesOrders, "Orders (Orders.h) by lines on standard input");
    app.add_option("--rate", o.Rate, "Notes a second to each");
    app.add_option("--accept-from", o.AcceptFrom, "Nodes whose notes are taken; default all");
    app.add_option("--payload", o.Payload, "Octets of padding in each note that is sent");
    app.add_option("--capacity", o.Capacity, "Notes that may wait in one outbox");
    app.add_option("--expire", o.ExpireS, "Seconds after which a note is too old; 0: never");
    app.add_option("--queue-room", o.QueueRoom, "Notes that fit into the local queue");
    app.add_flag("--held-notes", o.HeldNotes, "Take no note before the order `take`");
    app.add_option("--drain-period", o.DrainPeriodS,
                   "Seconds from one emptying of the local queue to the next");
    app.add_flag("--ticks", o.Ticks, "Publish ticks and follow those of the others");
    app.add_option("--tick-period-ns", o.TickPeriodNs,
                   "From one tick to the next; default a tenth of a second");
    app.add_option("--tick-payload", o.TickPayload, "Octets of padding in each tick");
    app.add_flag("--held-ticks", o.HeldTicks,
                 "A handler of the ticks of other nodes does not return before the order `return`");
    app.add_option("--pictures-to", o.Pictures.To, "Node to send pictures to, as bulk, once it is UP");
    app.add_flag("--take-pictures", o.TakesPictures);
    app.add_option("--pictures", o.Pictures.Count, "How many");
    app.add_option("--picture-bytes", o.Pictures.Size);
    app.add_option("--picture-period-ns", o.Pictures.PeriodNs,
                   "From one to the next; default as the link takes them");
    app.add_option("--states", o.States.Count,
                   "States that each node may publish; follow those of the others");
    app.add_option("--state-bytes", o.States.Size, "Octets of padding in each");
    app.add_option("--state-posts", o.States.Posts, "How often each of them is posted");
    app.add_option("--state-period-ns", o.States.PeriodNs, "From one post of each to its next");
}

void Run(Options &options)
{
    Rabit::GatewayConfig &config = options.Gateway;
    config.Accept.push_back({NotesQueue, {"Ledger::Note"}, options.AcceptFrom});
    if (options.Ticks)
    {
        config.Publish.push_back({"Tick", "Ledger::Tick", Rabit::QosProfile::Telemetry});
        config.Subscribe.push_back({"Tick", "Ledger::Tick"});
    }
    Rabit::SendRule rule;
    rule.Capacity = options.Capacity;
    rule.Window = options.Window;
    rule.Expire = std::chrono::milliseconds(static_cast<std::int64_t>(options.ExpireS * 1000));
    config.Send.push_back(rule);
    options.Life = Now();
    options.Pictures.Node = config.Node;
    options.Pictures.Life = static_cast<std::uint64_t>(options.Life);
    options.Pictures.LedgerFile = options.LedgerFile;
    std::vector<std::unique_ptr<Rabit::RabitManager>> managers;
    managers.push_back(std::make_unique<Clerk>(options));
    if (options.States.Count > 0)
    {
        options.States.LedgerFile = options.LedgerFile;
        TestNode::StateClerk::Configure(options.States, config);
        managers.push_back(std::make_unique<TestNode::StateClerk>(options.States, options.Orders));
    }
    if (options.TakesPictures || !options.Pictures.To.empty())
    {
        TestNode::PictureClerk::Configure(config);
        managers.push_back(std::make_unique<TestNode::PictureClerk>(options.Pictures));
    }
    TestNode::Run(config, std::move(managers));
}
}  // namespace

int main(int argc, char **argv)
{
    CLI::App app("A node that keeps a ledger of what it sends and receives.");
    Options options;
    Describe(app, options);
    return TestNode::Main(app, argc, argv, [&] { Run(options); });
}
