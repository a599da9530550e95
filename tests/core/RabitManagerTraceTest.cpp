#include <rabit/ManualClock.h>
#include <rabit/RabitManager.h>
#include <rabit/RabitManagerTrace.h>
#include <rabit/RabitSteppedReactor.h>
#include <rabit/RabitWorkspace.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "TestMessages.h"

namespace
{
using namespace std::chrono_literals;
using Rabit::RabitManagerTrace;
using RabitTest::NumberMessage;

// Records its calls, and answers with the values that the test sets.
class NotedTrace : public RabitManagerTrace
{
public:
    std::vector<std::string> Notes;
    std::optional<std::chrono::nanoseconds> GivenMonotonic;
    std::optional<Rabit::PostTime> GivenPostTime;
    std::optional<bool> GivenAnswer;

    void BeginStep(Step step, bool isTurn) override
    {
        Notes.push_back("begin " + std::to_string(static_cast<int>(step)) + (isTurn ? " turn" : ""));
    }
    void EndStep(bool threw) override { Notes.push_back(threw ? "threw" : "end"); }
    void ReadMonotonic(std::chrono::nanoseconds &time) override
    {
        Notes.push_back("monotonic");
        time = GivenMonotonic.value_or(time);
    }
    void ReadGpsTime(double &) override { Notes.push_back("gps"); }
    void Fetched(const Rabit::PublishSubscribeMessage &, const Rabit::RabitMessage &,
                 std::uint64_t number) override
    {
        Notes.push_back("fetched " + std::to_string(number));
    }
    std::optional<Rabit::PostTime> Posting(const Rabit::PublishSubscribeMessage &) override
    {
        return GivenPostTime;
    }
    void Posted(const Rabit::PublishSubscribeMessage &, const Rabit::RabitMessage &,
                std::uint64_t number) override
    {
        Notes.push_back("posted " + std::to_string(number));
    }
    void Taken(const std::string &queue, const Rabit::RabitMessage &) override
    {
        Notes.push_back("taken from " + queue);
    }
    std::optional<bool> Adding(const std::string &queue, const Rabit::RabitMessage &) override
    {
        Notes.push_back("adding to " + queue);
        return GivenAnswer;
    }
    void Added(bool accepted) override { Notes.push_back(accepted ? "added" : "refused"); }
    void Listed(std::vector<Rabit::MessageInfo> &) override { Notes.emplace_back("listed"); }
};

class DoingManager : public Rabit::RabitManager
{
public:
    DoingManager(Rabit::RabitWorkspace &workspace, std::function<void(DoingManager &)> work)
        : RabitManager("Doing", workspace), _work(std::move(work))
    {
        AddPublishSubscribeMessage("Number", Number);
        SetWakeupTimeDelayMSec(1000);
    }
    void ExecuteUnitOfWork() override { _work(*this); }

    std::shared_ptr<NumberMessage> Number = std::make_shared<NumberMessage>();

private:
    const std::function<void(DoingManager &)> _work;
};

class RabitManagerTraceTest : public testing::Test
{
protected:
    // Returns the calls of the trace for one unit of work, with its beginning and end.
    std::vector<std::string> Do(std::function<void(DoingManager &)> work)
    {
        _workspace.SetManagerTracing([this](const std::string &name)
                                     { return name == "Doing" ? _trace : nullptr; });
        auto manager = std::make_unique<DoingManager>(_workspace, std::move(work));
        Manager = manager.get();
        Reactor.AddManager(std::move(manager));
        Reactor.Start();
        _trace->Notes.clear();
        Reactor.RunDue();
        return _trace->Notes;
    }

    std::shared_ptr<Rabit::ManualClock> _clock = std::make_shared<Rabit::ManualClock>(1.4e9, 5s);
    Rabit::RabitWorkspace _workspace{_clock};
    std::shared_ptr<NotedTrace> _trace = std::make_shared<NotedTrace>();
    Rabit::RabitSteppedReactor Reactor{_workspace};
    DoingManager *Manager = nullptr;
    using Notes = std::vector<std::string>;
};

TEST_F(RabitManagerTraceTest, IsToldOfEachStepAndWhetherItThrew)
{
    EXPECT_EQ(Do([](DoingManager &) { throw 1; }), (Notes{"begin 1 turn", "threw"}));
    _trace->Notes.clear();
    Reactor.Stop();
    EXPECT_EQ(_trace->Notes, (Notes{"begin 2 turn", "end"}));
}

TEST_F(RabitManagerTraceTest, SeesReadingsOfTheClockAgesAmongThem)
{
    NumberMessage posted;
    ASSERT_TRUE(_workspace.AddPublishSubscribeMessage("Number", std::make_shared<NumberMessage>()));
    _workspace.FindGlobalMessage("Number")->PostMessage(&posted);
    EXPECT_EQ(
        Do(
            [](DoingManager &manager)
            {
                manager.GetWorkspace().GetClock().Monotonic();
                manager.GetWorkspace().GetClock().GpsTimeSeconds();
                manager.GetWorkspace().GetClock().Now();
                manager.Number->FetchMessage();
                manager.Number->GetAgeSeconds();
            }),
        (Notes{"begin 1 turn", "monotonic", "gps", "gps", "monotonic", "fetched 1", "monotonic", "end"}));
}

TEST_F(RabitManagerTraceTest, SeesTheSystemsClockAsWell)
{
    EXPECT_EQ(Do([](DoingManager &) { Rabit::RabitClock::System()->Now(); }),
              (Notes{"begin 1 turn", "gps", "monotonic", "end"}));
}

TEST_F(RabitManagerTraceTest, DecidesWhatTheClockShows)
{
    _trace->GivenMonotonic = 77s;
    std::chrono::nanoseconds seen{0};
    Do([&](DoingManager &manager) { seen = manager.GetWorkspace().GetClock().Monotonic(); });
    EXPECT_EQ(seen, 77s);
    EXPECT_EQ(_clock->Monotonic(), 5s) << "outside of its steps";
}

TEST_F(RabitManagerTraceTest, SeesAFetchOnlyIfItBroughtSomething)
{
    EXPECT_EQ(Do(
                  [](DoingManager &manager)
                  {
                      manager.Number->FetchMessage();
                      manager.Number->PostMessage();
                      manager.Number->FetchMessage();
                      manager.GetWorkspace().GetMessage("Number");
                  }),
              (Notes{"begin 1 turn", "posted 1", "fetched 1", "end"}));
}

TEST_F(RabitManagerTraceTest, DecidesWhenAPostWasMade)
{
    _trace->GivenPostTime = Rabit::PostTime{1.2e9, 3s};
    Do([](DoingManager &manager) { manager.Number->PostMessage(); });
    EXPECT_EQ(Manager->Number->GetTimeStamp(), 1.2e9);
    EXPECT_EQ(Manager->Number->GetPostTime().Monotonic, 3s);
}

TEST_F(RabitManagerTraceTest, SeesWhatIsTakenFromItsQueue)
{
    const auto take = [](DoingManager &manager)
    {
        std::shared_ptr<Rabit::RabitMessage> message;
        while (manager.GetManagerMessageQueue()->GetMessage(message))
        {
        }
    };
    Do(take);
    _trace->Notes.clear();
    _workspace.AddMessageToQueue("Doing", std::make_shared<NumberMessage>());
    Reactor.RunDue();
    EXPECT_EQ(_trace->Notes, (Notes{"begin 1 turn", "taken from Doing", "end"}));
}

TEST_F(RabitManagerTraceTest, SeesWhatIsAddedToQueuesByName)
{
    _workspace.AddManagerMessageQueue("Other", std::make_shared<Rabit::RabitManager::RabitQueue>(1, "Other"));
    EXPECT_EQ(Do(
                  [](DoingManager &manager)
                  {
                      manager.AddMessageToQueue("Other", std::make_shared<NumberMessage>());
                      manager.AddMessageToQueue("nobody", std::make_shared<NumberMessage>());
                  }),
              (Notes{"begin 1 turn", "adding to Other", "added", "adding to nobody", "refused", "end"}));
}

TEST_F(RabitManagerTraceTest, AnswersForAQueueThatThenGetsNothing)
{
    _trace->GivenAnswer = true;
    bool added = false;
    Do([&](DoingManager &manager)
       { added = manager.AddMessageToQueue("Doing", std::make_shared<NumberMessage>()); });
    EXPECT_TRUE(added);
    EXPECT_TRUE(Manager->GetManagerMessageQueue()->IsEmpty());
}

TEST_F(RabitManagerTraceTest, DoesNotSeeWhatHandlersDoOnTheManagersThread)
{
    const auto other = std::make_shared<NumberMessage>();
    ASSERT_TRUE(_workspace.AddPublishSubscribeMessage("Number", other));
    other->Register_SomethingPublished(
        [&]
        {
            other->FetchMessage();
            _clock->Monotonic();
        });
    EXPECT_EQ(Do(
                  [](DoingManager &manager)
                  {
                      manager.Number->PostMessage();
                      manager.GetWorkspace().GetListOfMessages();
                  }),
              (Notes{"begin 1 turn", "posted 1", "listed", "end"}));
}

TEST_F(RabitManagerTraceTest, IsNotToldOfManagersThatHaveNone)
{
    _workspace.SetManagerTracing([](const std::string &) { return nullptr; });
    auto manager =
        std::make_unique<DoingManager>(_workspace, [](DoingManager &one) { one.Number->PostMessage(); });
    Reactor.AddManager(std::move(manager));
    Reactor.Start();
    Reactor.RunDue();
    EXPECT_TRUE(_trace->Notes.empty());
    EXPECT_EQ(RabitManagerTrace::Current(), nullptr);
}

TEST_F(RabitManagerTraceTest, APassThatIsNotDueRunsWhenItIsAskedFor)
{
    std::vector<bool> turns;
    Do([&](DoingManager &manager) { turns.push_back(manager.IsTurn()); });
    Manager->SetPeriodSec(10);
    EXPECT_TRUE(Reactor.RunPassOf(*Manager, false));
    EXPECT_TRUE(Reactor.RunPassOf(*Manager, true));
    EXPECT_EQ(turns, (std::vector<bool>{true, false, true}));
    Reactor.Stop();
    EXPECT_FALSE(Reactor.RunPassOf(*Manager, true));
}

}  // namespace
