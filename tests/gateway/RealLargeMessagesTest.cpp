// Large messages of several nodes for one small queue, with all threads over each real backend, on loopback.
#include <gtest/gtest.h>
#include <rabit/RabitQueueReceipt.h>
#include <rabit/RabitReactor.h>
#include <rabit/gateway/GatewayManager.h>
#include <rabit/transport/TransportFactory.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <future>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "../Eventually.h"
#include "BackendPairs.h"
#include "DomainLease.h"
#include "keyed.idl.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using Queue = RabitMessageQueue<std::shared_ptr<RabitMessage>>;

constexpr std::uint32_t Senders = 3;
constexpr std::uint32_t LargeMessages = 100;  // of each
constexpr std::size_t Bytes = 60'000;         // all of one size, so that the size tells none apart
constexpr int Places = 20;

std::string TextOf(std::uint32_t sender, std::uint32_t message)
{
    std::string text = std::to_string(sender) + " " + std::to_string(message);
    text.resize(Bytes, '.');
    return text;
}

// Sends its messages one after the other, and waits until all have their outcomes.
class BulkSender final : public RabitManager
{
public:
    BulkSender(RabitWorkspace &workspace, std::uint32_t number)
        : RabitManager("Sender", workspace), _number(number)
    {
        SetWakeupTimeDelayMSec(1);
    }

    void ExecuteUnitOfWork() final
    {
        while (_receipts.size() < LargeMessages)
        {
            auto message = std::make_shared<GatewayTest::Contact>();
            const auto next = static_cast<std::uint32_t>(_receipts.size());
            message->number = _number;
            message->text = TextOf(_number, next);
            auto receipt = std::make_shared<RabitQueueReceipt>();
            if (!AddMessageToQueue("sink/Bulk", message, receipt))
            {
                return;  // not announced yet, or the outbox is full: again in the next unit of work
            }
            _receipts.push_back(std::move(receipt));
        }
        const bool settled =
            std::all_of(_receipts.begin(), _receipts.end(),
                        [](const auto &receipt) { return receipt->Outcome() != QueueOutcome::Pending; });
        if (settled && !_done)
        {
            _done = true;
            Outcomes.set_value(std::count_if(_receipts.begin(), _receipts.end(),
                                             [](const auto &receipt)
                                             { return receipt->Outcome() == QueueOutcome::Delivered; }));
        }
    }

    std::promise<std::ptrdiff_t> Outcomes;  // how many were delivered

private:
    const std::uint32_t _number;
    std::vector<std::shared_ptr<RabitQueueReceipt>> _receipts;
    bool _done = false;
};

// Takes all waiting messages, and then lets the queue become full again.
class BulkSink final : public RabitManager
{
public:
    explicit BulkSink(RabitWorkspace &workspace) : RabitManager("Sink", workspace)
    {
        AddManagerMessageQueue("Bulk", _queue);
        SetWakeupTimeDelayMSec(10);
    }

    void ExecuteUnitOfWork() final
    {
        std::shared_ptr<RabitMessage> message;
        while (_queue->GetMessage(message))
        {
            const auto contact = std::dynamic_pointer_cast<GatewayTest::Contact>(message);
            ASSERT_NE(contact, nullptr);
            ASSERT_LT(contact->number, Senders);
            std::uint32_t &next = _next[contact->number];
            const bool isNext = contact->text == TextOf(contact->number, next);
            EXPECT_TRUE(isNext) << "in place of message " << next << " came " << contact->text.substr(0, 12);
            ++next;
        }
    }

private:
    const std::shared_ptr<Queue> _queue = std::make_shared<Queue>(Places, "Bulk");
    std::array<std::uint32_t, Senders> _next{};
};

// A workspace, a reactor on a thread of its own, and a gateway.
class BulkNode
{
public:
    BulkNode(const std::string &transport, const std::string &name) : _reactor(_workspace)
    {
        _config.Node = name;
        _config.Domain = Conformance::OwnDomain();
        _config.Interfaces = {"127.0.0.1"};
        _reactor.SetHandleSignals(false);
        _transport = transport;
    }
    ~BulkNode()
    {
        _reactor.ShutdownAllManagers();
        _thread.join();
    }

    template <typename Manager, typename... Arguments>
    Manager &Run(Arguments... arguments)
    {
        auto manager = std::make_unique<Manager>(_workspace, arguments...);
        Manager &running = *manager;
        _reactor.AddManager(std::move(manager));
        _reactor.AddManager(std::make_unique<GatewayManager>(_config, MakeTransport(_transport), _workspace));
        _thread = std::thread([this] { _reactor.Run(); });
        return running;
    }
    void Accept(const AcceptRule &rule) { _config.Accept.push_back(rule); }

private:
    RabitWorkspace _workspace;
    RabitReactor _reactor;
    GatewayConfig _config;
    std::string _transport;
    std::thread _thread;
};

class RealLargeMessagesTest : public ::testing::TestWithParam<BackendPair>
{
};

TEST_P(RealLargeMessagesTest, OfSeveralNodesForOneFullQueueArriveOnceAndInOrder)
{
    BulkNode sink(GetParam().first, "sink");
    sink.Accept({.Queue = "Bulk", .Types = {"GatewayTest::Contact"}});
    sink.Run<BulkSink>();
    std::vector<std::unique_ptr<BulkNode>> nodes;
    std::vector<std::future<std::ptrdiff_t>> outcomes;
    for (std::uint32_t number = 0; number < Senders; ++number)
    {
        nodes.push_back(std::make_unique<BulkNode>(GetParam().second, "sender" + std::to_string(number)));
        outcomes.push_back(nodes.back()->Run<BulkSender>(number).Outcomes.get_future());
    }
    for (std::future<std::ptrdiff_t> &delivered : outcomes)
    {
        ASSERT_EQ(delivered.wait_for(RabitTest::Hangs), std::future_status::ready);
        EXPECT_EQ(delivered.get(), LargeMessages);
    }
}

INSTANTIATE_TEST_SUITE_P(Backends, RealLargeMessagesTest, ::testing::ValuesIn(AllBackendPairs()), NameOfPair);

}  // namespace
}  // namespace Rabit
