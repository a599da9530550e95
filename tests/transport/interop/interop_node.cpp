// A node that exchanges every kind of traffic with one other node. It prints a line for each thing that it
// sees, for interop_test.py, outage_test.py, suspension_test.py and ../fuzz:
//   ready life=L                          this process is up
//   peer STATE                            UP, STALE or LOST
//   mirror life=L                         the first counter of an incarnation of the other node
//   ten counters                          came since the last such line
//   resumed life=L after_s=S              counters come again, after more than a second without
//   frame life=L                          the 4 MB frame of this incarnation is whole; `frame life=L garbled`
//   if not orders life=L round=R count=N skipped=S    the last order of a round came: N came, S did not
//   hundred orders round=R                came since the last such line
//   order skipped round=R ...             never
//   order not in order ...                never
//   settled round=R delivered=D in_doubt=I     all orders of a round have their outcome
//   in doubt round=R                      never; the first of a round
//   lost round=R outcome=...              never: another outcome
//   stopped round=R sent=N delivered=D in_doubt=I    after SIGUSR1, which ends the sending: all orders of
//   this
//                       round have their outcome
// Ends on SIGTERM with exit code 0.
#include <rabit/RabitManager.h>
#include <rabit/gateway/GatewayManager.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <deque>
#include <iostream>
#include <memory>
#include <sstream>
#include <string>

#include "TestNode.h"
#include "gateway.idl.h"
#include "interop.idl.h"

namespace
{

using Clock = std::chrono::steady_clock;

constexpr const char *Queue = "Orders";
constexpr std::size_t FrameSize = 4'000'000;
constexpr auto CounterPeriod = std::chrono::milliseconds(100);
constexpr auto Pause = std::chrono::seconds(1);

struct Options
{
    Rabit::GatewayConfig Gateway;
    std::string Other;
    std::uint32_t Count = 100;
    double Rate = 200;
    bool Frame = true;
};

std::atomic<bool> stopped{false};

void Say(const std::string &line)
{
    std::cout << line + "\n" << std::flush;
}

std::vector<std::uint8_t> FrameOf(std::uint64_t life)
{
    std::vector<std::uint8_t> body(FrameSize);
    for (std::size_t i = 0; i < body.size(); ++i)
    {
        body[i] = static_cast<std::uint8_t>(life + i);
    }
    return body;
}

class Exchange : public Rabit::RabitManager
{
public:
    explicit Exchange(const Options &options)
        : RabitManager("Exchange"),
          _options(options),
          _life(static_cast<std::uint64_t>(::getpid())),
          _orders(std::make_shared<RabitQueue>(1000, Queue))
    {
        AddManagerMessageQueue(Queue, _orders);
        WakeUpManagerOnEnqueue(_orders);
        AddPublishSubscribeMessage(Rabit::FleetMessageName, _fleet);
        AddPublishSubscribeMessage("Counter", _counter);
        AddPublishSubscribeMessage("Frame", _frame);
        AddPublishSubscribeMessage(options.Other + "/Counter", _otherCounter);
        AddPublishSubscribeMessage(options.Other + "/Frame", _otherFrame);
        SetWakeupTimeDelayMSec(10);
    }

    void Startup() final { Say("ready life=" + std::to_string(_life)); }

    void ExecuteUnitOfWork() final
    {
        FollowFleet();
        FollowMirrors();
        Receive();
        Post();
        Send();
        FollowReceipts();
    }

private:
    void FollowFleet()
    {
        if (!_fleet->FetchMessage())
        {
            return;
        }
        for (const auto &node : _fleet->nodes)
        {
            const char *state = node.state == Rabit::Gateway::NodeState::UP      ? "UP"
                                : node.state == Rabit::Gateway::NodeState::STALE ? "STALE"
                                                                                 : "LOST";
            if (node.node == _options.Other && _state != state)
            {
                _state = state;
                Say(std::string("peer ") + state);
            }
            if (node.node == _options.Other && node.state == Rabit::Gateway::NodeState::UP && _round == 0)
            {
                BeginRound();
            }
        }
    }

    void BeginRound()
    {
        ++_round;
        _sent = 0;
        _roundStart = Clock::now();
    }

    void FollowMirrors()
    {
        if (_otherCounter->FetchMessage())
        {
            const auto now = Clock::now();
            if (_counterLife != _otherCounter->life)
            {
                _counterLife = _otherCounter->life;
                Say("mirror life=" + std::to_string(_counterLife));
            }
            else if (now - _lastCounter > Pause)
            {
                std::ostringstream line;
                line << "resumed life=" << _counterLife
                     << " after_s=" << std::chrono::duration<double>(now - _lastCounter).count();
                Say(line.str());
            }
            _lastCounter = now;
            if (++_counters % 10 == 0)
            {
                Say("ten counters");
            }
        }
        if (_otherFrame->FetchMessage() && _otherFrame->life != _frameLife)
        {
            _frameLife = _otherFrame->life;
            const bool whole = _otherFrame->body == FrameOf(_frameLife);
            Say("frame life=" + std::to_string(_frameLife) + (whole ? "" : " garbled"));
        }
    }

    void Receive()
    {
        std::shared_ptr<Rabit::RabitMessage> message;
        while (_orders->GetMessage(message))
        {
            const auto order = std::dynamic_pointer_cast<Interop::Order>(message);
            if (!order)
            {
                Say("order not in order: another type");
                continue;
            }
            if (order->life != _orderLife && _orderLife != 0)
            {
                // The other node is back. Orders sent before its links are heard of again may be in doubt.
                // From this moment on everything must arrive.
                BeginRound();
            }
            if (order->life != _orderLife || order->round != _orderRound)
            {
                _orderLife = order->life;
                _orderRound = order->round;
                _received = 0;
                _last = 0;
            }
            std::ostringstream line;
            if (order->number <= _last)
            {
                line << "order not in order: " << order->number << " after " << _last;
                Say(line.str());
            }
            else if (order->number != _last + 1)
            {
                line << "order skipped round=" << order->round << ": " << order->number << " after " << _last;
                Say(line.str());
            }
            _last = order->number;
            ++_received;
            if (_received % 100 == 0)
            {
                Say("hundred orders round=" + std::to_string(order->round));
            }
            line.str("");
            if (_last == _options.Count)
            {
                line << "orders life=" << _orderLife << " round=" << _orderRound << " count=" << _received
                     << " skipped=" << _options.Count - _received;
                Say(line.str());
            }
        }
    }

    void Post()
    {
        if (Clock::now() >= _nextCounter)
        {
            _nextCounter = Clock::now() + CounterPeriod;
            _counter->life = _life;
            ++_counter->number;
            _counter->PostMessage();
        }
        if (_options.Frame && _round > 0 && !_framePosted)
        {
            _framePosted = true;
            _frame->life = _life;
            _frame->body = FrameOf(_life);
            _frame->PostMessage();
        }
    }

    void Send()
    {
        const double due = std::chrono::duration<double>(Clock::now() - _roundStart).count() * _options.Rate;
        while (_round > 0 && !stopped && _sent < _options.Count && _sent < due)
        {
            auto order = std::make_shared<Interop::Order>();
            order->life = _life;
            order->round = _round;
            order->number = _sent + 1;
            auto receipt = std::make_shared<Rabit::RabitQueueReceipt>();
            if (!AddMessageToQueue(_options.Other + "/" + Queue, order, receipt))
            {
                return;  // not announced yet, or the outbox is full
            }
            ++_sent;
            _receipts.emplace_back(_round, receipt);
        }
    }

    void FollowReceipts()
    {
        while (!_receipts.empty() && _receipts.front().second->Outcome() != Rabit::QueueOutcome::Pending)
        {
            const auto [round, receipt] = _receipts.front();
            _receipts.pop_front();
            if (round != _receiptRound)
            {
                _receiptRound = round;
                _delivered = 0;
                _inDoubt = 0;
            }
            std::ostringstream line;
            switch (receipt->Outcome())
            {
                case Rabit::QueueOutcome::Delivered:
                    ++_delivered;
                    break;
                case Rabit::QueueOutcome::InDoubt:
                    if (++_inDoubt == 1)
                    {
                        Say("in doubt round=" + std::to_string(round));
                    }
                    break;
                default:
                    line << "lost round=" << round << " outcome=" << Rabit::ToString(receipt->Outcome());
                    Say(line.str());
                    break;
            }
            if (_delivered + _inDoubt == _options.Count)
            {
                line << "settled round=" << round << " delivered=" << _delivered << " in_doubt=" << _inDoubt;
                Say(line.str());
            }
        }
        if (stopped && _receipts.empty() && !_saidStopped)
        {
            _saidStopped = true;
            std::ostringstream line;
            line << "stopped round=" << _receiptRound << " sent=" << _sent << " delivered=" << _delivered
                 << " in_doubt=" << _inDoubt;
            Say(line.str());
        }
    }

    const Options &_options;
    const std::uint64_t _life;
    std::shared_ptr<RabitQueue> _orders;
    std::shared_ptr<Rabit::Gateway::Fleet> _fleet = std::make_shared<Rabit::Gateway::Fleet>();
    std::shared_ptr<Interop::Counter> _counter = std::make_shared<Interop::Counter>();
    std::shared_ptr<Interop::Counter> _otherCounter = std::make_shared<Interop::Counter>();
    std::shared_ptr<Interop::Frame> _frame = std::make_shared<Interop::Frame>();
    std::shared_ptr<Interop::Frame> _otherFrame = std::make_shared<Interop::Frame>();
    std::string _state;
    std::uint64_t _counterLife = 0;
    std::uint64_t _frameLife = 0;
    std::uint64_t _counters = 0;
    Clock::time_point _lastCounter{};
    Clock::time_point _nextCounter{};
    bool _framePosted = false;
    bool _saidStopped = false;
    std::uint32_t _round = 0;
    std::uint32_t _sent = 0;
    Clock::time_point _roundStart{};
    std::deque<std::pair<std::uint32_t, std::shared_ptr<Rabit::RabitQueueReceipt>>> _receipts;
    std::uint32_t _receiptRound = 0;
    std::uint32_t _delivered = 0;
    std::uint32_t _inDoubt = 0;
    std::uint64_t _orderLife = 0;
    std::uint32_t _orderRound = 0;
    std::uint32_t _last = 0;
    std::uint32_t _received = 0;
};

void Describe(CLI::App &app, Options &options)
{
    TestNode::DescribeNetwork(app, options.Gateway);
    app.add_option("--other", options.Other, "Name of the other node")->required();
    app.add_option("--count", options.Count, "Orders for each life of the other node");
    app.add_option("--rate", options.Rate, "Orders a second");
    app.add_flag("!--no-frame", options.Frame, "Send no frame of 4 MB");
}

void Run(Options &options)
{
    auto &config = options.Gateway;
    config.Publish.push_back(
        {.Message = "Counter", .Type = "Interop::Counter", .Qos = Rabit::QosProfile::Telemetry});
    config.Subscribe.push_back({.Message = "Counter", .Type = "Interop::Counter"});
    config.Publish.push_back({.Message = "Frame", .Type = "Interop::Frame"});
    config.Subscribe.push_back({.Message = "Frame", .Type = "Interop::Frame"});
    config.Accept.push_back({.Queue = Queue, .Types = {"Interop::Order"}});
    std::vector<std::unique_ptr<Rabit::RabitManager>> managers;
    managers.push_back(std::make_unique<Exchange>(options));
    TestNode::Run(config, std::move(managers));
}

}  // namespace

int main(int argc, char **argv)
{
    std::signal(SIGUSR1, [](int) { stopped = true; });
    CLI::App app("A node that exchanges every kind of traffic with one other node.");
    Options options;
    Describe(app, options);
    return TestNode::Main(app, argc, argv, [&] { Run(options); });
}
