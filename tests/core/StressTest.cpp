#include "CapturedLog.h"
#include "TestManagers.h"
#include "TestMessages.h"

#include <rabit/RabitReactor.h>

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cstdint>

#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

// Many threads at once. These tests find their errors under ThreadSanitizer and AddressSanitizer.
namespace
{

using namespace Rabit;
using namespace RabitTest;

// A message whose two numbers belong together, so that a torn copy shows.
class PairMessage : public RabitMessage
{
public:
    std::uint64_t Value = 0;
    std::array<std::uint64_t, 15> Copies{};

    void Set(std::uint64_t value)
    {
        Value = value;
        Copies.fill(value);
    }
    bool IsWhole() const
    {
        for (const std::uint64_t copy : Copies)
        {
            if (copy != Value)
            {
                return false;
            }
        }
        return true;
    }
    std::unique_ptr<RabitMessage> Clone() const override { return std::make_unique<PairMessage>(*this); }
    bool CopyMessage(RabitMessage *msg) override
    {
        const auto *other = dynamic_cast<const PairMessage *>(msg);
        if (other != nullptr)
        {
            *this = *other;
        }
        return other != nullptr;
    }
};

TEST(Stress, AFetchAgainstAPosterGetsWholeValuesThatNeverGoBackAndMissesNoLastOne)
{
    constexpr std::uint64_t posts = 100000;
    RabitWorkspace workspace;
    const auto poster = std::make_shared<PairMessage>();
    workspace.AddPublishSubscribeMessage("Pair", poster);
    std::vector<std::thread> readers;
    std::atomic<bool> wrong{false};
    for (int r = 0; r < 2; ++r)
    {
        const auto reader = std::make_shared<PairMessage>();
        workspace.AddPublishSubscribeMessage("Pair", reader);
        readers.emplace_back(
            [reader, &wrong]
            {
                std::uint64_t last = 0;
                double lastStamp = 0.0;
                while (last < posts)
                {
                    if (reader->FetchMessage())
                    {
                        if (!reader->IsWhole() || (reader->Value != 0 && reader->Value <= last) ||
                            reader->GetTimeStamp() < lastStamp)
                        {
                            wrong = true;
                            return;
                        }
                        last = reader->Value;
                        lastStamp = reader->GetTimeStamp();
                    }
                }
            });
    }
    for (std::uint64_t value = 1; value <= posts; ++value)
    {
        poster->Set(value);
        poster->PostMessage();
    }
    for (std::thread &reader : readers)
    {
        reader.join();
    }
    EXPECT_FALSE(wrong);
}

// Registers, posts, fetches and queues in every unit of work, a million operations in all.
class BusyManager : public RabitManager
{
public:
    static constexpr int Managers = 8;
    static constexpr int OperationsEach = 125000;

    BusyManager(int index, RabitWorkspace &workspace)
        : RabitManager("Busy" + std::to_string(index), workspace), _index(index)
    {
        SetWakeupTimeDelayMSec(0);
    }

    void Startup() final
    {
        for (int other = 0; other < Managers; ++other)
        {
            _messages.push_back(std::make_shared<PairMessage>());
            AddPublishSubscribeMessage("Pair" + std::to_string(other), _messages.back());
            WakeUpManagerOnMessagePost(_messages.back());
        }
    }

    void ExecuteUnitOfWork() final
    {
        for (int i = 0; i < 100; ++i)
        {
            Operate();
        }
        if (_operations >= OperationsEach)
        {
            ShutdownManager();
        }
    }

    void Shutdown() final { Drain(); }

    bool Torn = false;
    int Sent = 0;
    int Received = 0;

private:
    void Operate()
    {
        const auto other = static_cast<std::size_t>(++_operations % Managers);
        switch (_operations % 5)
        {
            case 0:
                _messages[static_cast<std::size_t>(_index)]->Set(static_cast<std::uint64_t>(_operations));
                _messages[static_cast<std::size_t>(_index)]->PostMessage();
                break;
            case 1:
            case 2:
                if (_messages[other]->FetchMessage())
                {
                    Torn = Torn || !_messages[other]->IsWhole();
                }
                break;
            case 3:
                Sent += AddMessageToQueue("Busy" + std::to_string(other), std::make_shared<PairMessage>())
                            ? 1
                            : 0;
                Drain();
                break;
            default:
                Register();
                break;
        }
    }

    void Register()
    {
        const std::string name = "Extra" + std::to_string(_operations % 50);
        const auto message = std::make_shared<PairMessage>();
        if (_operations % 1000 < 5)
        {
            AddPublishSubscribeMessage(name, message);
        }
        else
        {
            GetWorkspace().AddPublishSubscribeMessage(name, message);
        }
        message->FetchMessage();
    }

    void Drain()
    {
        std::shared_ptr<RabitMessage> message;
        while (GetManagerMessageQueue()->GetMessage(message))
        {
            ++Received;
        }
    }

    const int _index;
    int _operations = 0;
    std::vector<std::shared_ptr<PairMessage>> _messages;
};

TEST(Stress, EightManagersRegisterPostFetchAndQueueAMillionTimes)
{
    RabitWorkspace workspace;
    RabitReactor reactor(workspace);
    std::vector<BusyManager *> managers;
    for (int i = 0; i < BusyManager::Managers; ++i)
    {
        auto manager = std::make_unique<BusyManager>(i, workspace);
        managers.push_back(manager.get());
        reactor.AddManager(std::move(manager));
    }
    reactor.Run();
    int sent = 0;
    int received = 0;
    for (BusyManager *manager : managers)
    {
        EXPECT_FALSE(manager->Torn) << manager->GetManagerName();
        sent += manager->Sent;
        // Messages that came after the manager's Shutdown are still in its queue.
        received += manager->Received + manager->GetManagerMessageQueue()->NoMessagesInQueue();
    }
    EXPECT_GT(sent, 0);
    EXPECT_EQ(received, sent);
}

TEST(Stress, AReactorStartsAndStopsFiveHundredTimes)
{
    RabitWorkspace workspace;
    RabitReactor reactor(workspace);
    std::vector<ScriptedManager *> managers;
    for (const char *name : {"First", "Second", "Third"})
    {
        auto manager = std::make_unique<ScriptedManager>(name, workspace);
        manager->SetWakeupTimeDelaySec(1e6);
        managers.push_back(manager.get());
        reactor.AddManager(std::move(manager));
    }
    for (int run = 1; run <= 500; ++run)
    {
        std::thread running([&] { reactor.Run(); });
        if (run % 2 == 0)
        {
            ASSERT_TRUE(Eventually([&] { return managers[1]->Startups == run; }));
            managers[1]->ShutdownAllManagers(true);
        }
        else
        {
            reactor.ShutdownAllManagers();
        }
        running.join();
        for (const ScriptedManager *manager : managers)
        {
            ASSERT_EQ(manager->Startups, run);
            ASSERT_EQ(manager->Shutdowns, run);
        }
    }
}

TEST(Stress, AReactorIsMadeAndDestroyedFiveHundredTimes)
{
    RabitWorkspace workspace;
    for (int i = 0; i < 500; ++i)
    {
        RabitReactor reactor(workspace);
        auto manager = std::make_unique<ScriptedManager>("Manager", workspace);
        manager->OnWork = [mgr = manager.get()] { mgr->ShutdownAllManagers(true); };
        reactor.AddManager(std::move(manager));
        reactor.Run();
        ASSERT_TRUE(workspace.GetListOfMessages().empty());
    }
}

TEST(Stress, SlowThrowingAndBlockingManagersDoNotHinderHealthyOnes)
{
    const CapturedLog log;
    RabitWorkspace workspace;
    RabitReactor reactor(workspace);
    const auto add = [&](const char *name)
    {
        auto manager = std::make_unique<ScriptedManager>(name, workspace);
        ScriptedManager *const added = manager.get();
        reactor.AddManager(std::move(manager));
        return added;
    };
    ScriptedManager *const slow = add("Slow");
    ScriptedManager *const throwing = add("Throwing");
    ScriptedManager *const blocking = add("Blocking");
    ScriptedManager *const failingStart = add("FailingStart");
    ScriptedManager *const healthy = add("Healthy");
    std::atomic<bool> release{false};
    throwing->SetWakeupTimeDelayMSec(0);
    throwing->OnWork = [] { throw std::runtime_error("always"); };
    blocking->OnWork = [&] { Eventually([&] { return release.load(); }); };
    failingStart->OnStartup = [] { throw 1; };
    healthy->SetWakeupTimeDelayMSec(1);
    slow->OnWork = [&]
    { Eventually([&, until = healthy->Passes + 20] { return healthy->Passes >= until || release; }); };
    healthy->OnWork = [&]
    {
        // All of this happens while the blocking manager is in its first unit of work.
        if (healthy->Passes == 200)
        {
            healthy->ShutdownAllManagers(true);
            release = true;
        }
    };
    reactor.Run();
    EXPECT_EQ(healthy->Passes, 200);
    EXPECT_EQ(blocking->Passes, 1);
    EXPECT_EQ(failingStart->Passes, 0);
    EXPECT_GE(throwing->Passes, 1);
    for (const ScriptedManager *manager : {slow, throwing, blocking, failingStart, healthy})
    {
        EXPECT_EQ(manager->Shutdowns, 1);
    }
}

TEST(Stress, CrossedHandlersThatPostToEachOtherDoNotDeadlock)
{
    RabitWorkspace workspace;
    const auto make = [&](const char *name)
    {
        const auto message = std::make_shared<NumberMessage>();
        workspace.AddPublishSubscribeMessage(name, message);
        return message;
    };
    // Each handler posts the other message, with a message of its own thread, to a depth of three.
    static thread_local int depth = 0;
    const auto cross = [&](const char *name)
    {
        if (depth < 3)
        {
            ++depth;
            NumberMessage message;
            message.SetGlobalPublishSubscribeMessageRef(workspace.FindGlobalMessage(name));
            message.PostMessage();
            --depth;
        }
    };
    const auto left = make("Left");
    const auto right = make("Right");
    left->Register_SomethingPublished([&] { cross("Right"); });
    right->Register_SomethingPublished([&] { cross("Left"); });
    constexpr int posts = 2000;
    const auto post = [](NumberMessage &message)
    {
        for (int i = 0; i < posts; ++i)
        {
            message.PostMessage();
        }
    };
    std::thread other([&] { post(*left); });
    post(*right);
    other.join();
    // Each post causes three more, alternating between the two.
    EXPECT_EQ(workspace.FindGlobalMessage("Left")->GetNumberOfPosts(), 4u * posts);
    EXPECT_EQ(workspace.FindGlobalMessage("Right")->GetNumberOfPosts(), 4u * posts);
}

TEST(Stress, ManagersThatWakeEachOtherMissNoWakeUp)
{
    // A ball goes back and forth. One missed wake-up would stop it.
    constexpr int rounds = 5000;
    RabitWorkspace workspace;
    RabitReactor reactor(workspace);
    std::atomic<int> played{0};
    const auto addPlayer = [&](const char *name, const char *partner, bool serves)
    {
        auto manager = std::make_unique<ScriptedManager>(name, workspace);
        ScriptedManager *const player = manager.get();
        player->SetWakeupTimeDelaySec(1e6);
        if (serves)
        {
            player->OnStartup = [player, partner]
            { player->AddMessageToQueue(partner, std::make_shared<NumberMessage>()); };
        }
        player->OnWork = [player, partner, &played]
        {
            std::shared_ptr<RabitMessage> ball;
            while (player->GetManagerMessageQueue()->GetMessage(ball))
            {
                if (++played < rounds)
                {
                    player->AddMessageToQueue(partner, ball);
                }
            }
        };
        reactor.AddManager(std::move(manager));
    };
    addPlayer("Left", "Right", true);
    addPlayer("Right", "Left", false);
    std::thread running([&] { reactor.Run(); });
    EXPECT_TRUE(Eventually([&] { return played == rounds; })) << "it lies still after " << played;
    reactor.ShutdownAllManagers();
    running.join();
}

}  // namespace
