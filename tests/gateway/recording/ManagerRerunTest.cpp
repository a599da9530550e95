// A manager that is recorded while it works with others, and is then run again alone.
#include <rabit/ManualClock.h>
#include <rabit/RabitReactor.h>
#include <rabit/RabitSteppedReactor.h>
#include <rabit/recording/ManagerRerun.h>
#include <rabit/recording/RecorderManager.h>

#include <gtest/gtest.h>

#include <unistd.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "recording/rerun/ManagerStep.h"
#include "recording/rerun/StepText.h"
#include "uav.idl.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;

// Follows poses, takes points to fly to, reports how far it got.
class Guide : public RabitManager
{
public:
    Guide(RabitWorkspace &workspace, float gain) : RabitManager("Guide", workspace), _gain(gain)
    {
        AddPublishSubscribeMessage("Pose", _pose);
        AddPublishSubscribeMessage("MissionState", _state);
        WakeUpManagerOnMessagePost(_pose);
        SetWakeupTimeDelayMSec(100);
    }
    std::function<void(Guide &)> Besides = [](Guide &) {};
    std::shared_ptr<Uav::Pose> _pose = std::make_shared<Uav::Pose>();

    void Startup() override { _began = GetWorkspace().GetClock().Monotonic(); }
    void ExecuteUnitOfWork() override
    {
        if (_pose->FetchMessage())
        {
            ++_state->poses;
        }
        std::shared_ptr<RabitMessage> message;
        while (GetManagerMessageQueue()->GetMessage(message))
        {
            const auto &command = dynamic_cast<const Uav::Goto &>(*message);
            _state->last_command = command.id;
            auto course = std::make_shared<Uav::Course>();
            course->speed_mps = _gain * command.speed_mps;
            _refused += AddMessageToQueue("Autopilot", course) ? 0U : 1U;
        }
        Besides(*this);
        const std::chrono::duration<double> since = GetWorkspace().GetClock().Monotonic() - _began;
        _state->floor_m = static_cast<float>(since.count());
        _state->home_latitude_deg = static_cast<float>(_pose->GetAgeSeconds());
        _state->commands = _refused;
        _state->PostMessage();
    }

private:
    const float _gain;
    std::chrono::nanoseconds _began{0};
    std::uint32_t _refused = 0;
    std::shared_ptr<Uav::MissionState> _state = std::make_shared<Uav::MissionState>();
};

class ManagerRerunTest : public testing::Test
{
protected:
    ManagerRerunTest() { std::filesystem::remove_all(Folder); }
    ~ManagerRerunTest() override { std::filesystem::remove_all(Folder); }

    GatewayConfig Config()
    {
        GatewayConfig config;
        config.Node = "uav1";
        config.Record.emplace();
        config.Record->Folder = Folder.string();
        config.Record->Free = 0;
        config.Record->Steps = {"Guide"};
        return config;
    }
    std::vector<std::string> Files() const
    {
        std::vector<std::string> files;
        for (const auto &entry : std::filesystem::directory_iterator(Folder))
        {
            files.push_back(entry.path());
        }
        return files;
    }
    // Poses and commands come, and the queue of the autopilot has room for two.
    void Fly(const std::function<void(Guide &)> &besides = [](Guide &) {})
    {
        const auto clock = std::make_shared<ManualClock>(1.4e9, 1000s);
        RabitWorkspace workspace(clock);
        GatewayConfig config = Config();
        RabitSteppedReactor reactor(workspace);
        const auto pose = std::make_shared<Uav::Pose>();
        workspace.AddPublishSubscribeMessage("Pose", pose);
        workspace.AddManagerMessageQueue("Autopilot",
                                         std::make_shared<RabitManager::RabitQueue>(2, "Autopilot"));
        auto guide = std::make_unique<Guide>(workspace, 2.0F);
        guide->Besides = besides;
        reactor.AddManager(std::move(guide));
        reactor.AddManager(std::make_unique<RecorderManager>(config, workspace));
        reactor.Start();
        for (std::uint32_t i = 1; i <= 20; ++i)
        {
            pose->number = i;
            pose->PostMessage();
            if (i % 5 == 0)
            {
                auto command = std::make_shared<Uav::Goto>();
                command->id = i;
                command->speed_mps = static_cast<float>(i) / 3;
                workspace.AddMessageToQueue("Guide", command);
            }
            reactor.RunFor(*clock, 37ms);
        }
        reactor.Stop();
    }
    ManagerRecording Recording()
    {
        const auto all = ManagerRecording::Read(Files(), "Guide", "uav1", Problems);
        EXPECT_EQ(all.size(), 1U);
        return all.at(0);
    }
    static RerunResult Rerun(
        const ManagerRecording &recording, float gain = 2.0F,
        const std::function<void(Guide &)> &besides = [](Guide &) {})
    {
        return ManagerRerun::Run(recording,
                                 [&](RabitWorkspace &workspace)
                                 {
                                     auto guide = std::make_unique<Guide>(workspace, gain);
                                     guide->Besides = besides;
                                     return guide;
                                 });
    }

    const std::filesystem::path Folder =
        std::filesystem::temp_directory_path() / ("rabit_rerun_" + std::to_string(::getpid()));
    std::vector<std::string> Problems;
};

TEST_F(ManagerRerunTest, DoesTheSameAgain)
{
    Fly();
    const ManagerRecording recording = Recording();
    EXPECT_TRUE(Problems.empty());
    EXPECT_EQ(recording.Problem(), "");
    const RerunResult result = Rerun(recording);
    EXPECT_EQ(result.Problem, "");
    EXPECT_FALSE(result.Difference) << result.Difference->ToString();
    EXPECT_EQ(result.Steps, recording.NumberOfSteps());
    EXPECT_GT(result.Steps, 22U);
    EXPECT_EQ(result.Outputs, result.Steps - 2 + 4) << "a state in each unit of work, and four courses";
    EXPECT_EQ(Rerun(recording).Digest, result.Digest);
}

TEST_F(ManagerRerunTest, NamesTheFirstThingThatAManagerDoesOtherwise)
{
    Fly();
    const RerunResult result = Rerun(Recording(), 3.0F);
    EXPECT_EQ(result.Problem, "");
    ASSERT_TRUE(result.Difference);
    EXPECT_EQ(result.Difference->What, "Uav::Course for queue Autopilot");
    EXPECT_EQ(result.Difference->Field, "speed_mps");
    EXPECT_EQ(result.Difference->Recorded, "3.3333333");
    EXPECT_EQ(result.Difference->Computed, "5");
    EXPECT_NEAR(result.Difference->SinceStartupS, 4 * 0.037, 1e-9) << "the fifth pose came with a command";
    EXPECT_EQ(result.Steps, result.Difference->Step + 1) << "it stops there";
}

TEST_F(ManagerRerunTest, NoticesWhatWasNotPostedThen)
{
    Fly();
    const auto besides = [](Guide &guide) { guide._pose->PostMessage(); };
    const RerunResult result = Rerun(Recording(), 2.0F, besides);
    ASSERT_TRUE(result.Difference);
    EXPECT_EQ(result.Difference->What, "message MissionState");
    EXPECT_EQ(result.Difference->Computed, "message Pose");
    EXPECT_EQ(result.Difference->Step, 1U);
}

TEST_F(ManagerRerunTest, NoticesAnExceptionThatWasNotThrownThen)
{
    Fly();
    const RerunResult result = Rerun(Recording(), 2.0F, [](Guide &) { throw std::runtime_error("no"); });
    ASSERT_TRUE(result.Difference);
    EXPECT_EQ(result.Difference->Computed, "nothing");
}

TEST_F(ManagerRerunTest, BringsAMessageThatChangesWithinAUnitOfWork)
{
    // Another manager posts in between. Each of two copies may see a different value.
    const auto second = std::make_shared<Uav::Pose>();
    const auto besides = [second](Guide &guide)
    {
        if (!second->GetGlobalPublishSubscribeMessageRef())
        {
            guide.GetWorkspace().AddPublishSubscribeMessage("Pose", second);
        }
        if (second->FetchMessage())
        {
            auto course = std::make_shared<Uav::Course>();
            course->number = second->number;
            guide.AddMessageToQueue("Log", course);
        }
    };
    Fly(besides);
    second->SetGlobalPublishSubscribeMessageRef(nullptr);
    const RerunResult result = Rerun(Recording(), 2.0F, besides);
    EXPECT_TRUE(result.IsAlike()) << result.Problem
                                  << (result.Difference ? result.Difference->ToString() : "");
}

TEST_F(ManagerRerunTest, DoesTheSameAgainAfterARunOnThreads)
{
    RabitWorkspace workspace;
    {
        GatewayConfig config = Config();
        RabitReactor reactor(workspace);
        reactor.SetHandleSignals(false);
        auto guide = std::make_unique<Guide>(workspace, 2.0F);
        std::atomic<int> units{0};
        guide->Besides = [&](Guide &one)
        {
            if (++units == 300)
            {
                one.ShutdownAllManagers(true);
            }
        };
        reactor.AddManager(std::move(guide));
        reactor.AddManager(std::make_unique<RecorderManager>(config, workspace));
        std::atomic<bool> ended{false};
        std::vector<std::thread> posters;
        for (int i = 0; i < 2; ++i)
        {
            posters.emplace_back(
                [&]
                {
                    const auto pose = std::make_shared<Uav::Pose>();
                    workspace.AddPublishSubscribeMessage("Pose", pose);
                    while (!ended)
                    {
                        ++pose->number;
                        pose->PostMessage();
                        auto command = std::make_shared<Uav::Goto>();
                        command->id = pose->number;
                        workspace.AddMessageToQueue("Guide", command);
                        std::this_thread::yield();
                    }
                });
        }
        reactor.Run();
        ended = true;
        for (std::thread &poster : posters)
        {
            poster.join();
        }
    }
    const ManagerRecording recording = Recording();
    EXPECT_EQ(recording.Problem(), "");
    EXPECT_GE(recording.NumberOfSteps(), 300U);
    int units = 0;
    const auto besides = [&units](Guide &one)
    {
        if (++units == 300)
        {
            one.ShutdownAllManagers(true);
        }
    };
    const RerunResult result = Rerun(recording, 2.0F, besides);
    EXPECT_TRUE(result.IsAlike()) << result.Problem
                                  << (result.Difference ? result.Difference->ToString() : "");
    EXPECT_GE(result.Steps, 300U);
}

TEST_F(ManagerRerunTest, SaysWhichManagerWasNotRecorded)
{
    Fly();
    EXPECT_TRUE(ManagerRecording::Read(Files(), "Pilot", "uav1", Problems).empty());
    EXPECT_EQ(Problems, std::vector<std::string>{"no steps of a manager Pilot of uav1 were recorded"});
}

TEST_F(ManagerRerunTest, KeepsLivesApart)
{
    Fly();
    Fly();
    const auto lives = ManagerRecording::Read(Files(), "Guide", "", Problems);
    ASSERT_EQ(lives.size(), 1U) << "the same times by the same clock: a copy";
    EXPECT_TRUE(Rerun(lives[0]).IsAlike());
}

TEST_F(ManagerRerunTest, SaysThatAFileIsMissing)
{
    EXPECT_TRUE(ManagerRecording::Read({Folder / "none.mcap"}, "Guide", "", Problems).empty());
    ASSERT_EQ(Problems.size(), 2U);
    EXPECT_NE(Problems[0].find("none.mcap"), std::string::npos);
}

TEST(StepText, GivesBackWhatItWasMadeOf)
{
    Rerun::ManagerStep step;
    step.What = RabitManagerTrace::Step::UnitOfWork;
    step.Number = std::uint64_t{1} << 63;
    step.IsTurn = false;
    step.Threw = true;
    step.Began = std::chrono::nanoseconds(std::int64_t{1} << 62);
    step.BeganGpsTime = 1448272800.1234567;
    Rerun::StepEvent event;
    event.What = Rerun::StepEvent::Kind::Fetched;
    event.Name = "uav2/Pose";
    event.Type = "Uav::Pose";
    event.Number = 5;
    event.WasPosted = true;
    event.Monotonic = -3ns;
    event.GpsTime = 0.1;
    event.IsRedelivered = true;
    event.Sample = {0, 1, 255, 16};
    step.Events.push_back(event);
    event = {};
    event.What = Rerun::StepEvent::Kind::Listed;
    event.Names = {{"a", "A"}, {"b", ""}};
    step.Events.push_back(event);
    const std::string text = Rerun::TextOf(step);
    const auto back = Rerun::StepOf(text);
    ASSERT_TRUE(back);
    EXPECT_EQ(Rerun::TextOf(*back), text);
    EXPECT_EQ(back->Number, step.Number);
    EXPECT_EQ(back->BeganGpsTime, step.BeganGpsTime);
    ASSERT_EQ(back->Events.size(), 2U);
    EXPECT_EQ(back->Events[0].Sample, step.Events[0].Sample);
    EXPECT_EQ(back->Events[0].Monotonic, -3ns);
    EXPECT_EQ(back->Events[1].Names, step.Events[1].Names);
}

TEST(StepText, TakesNoOtherText)
{
    Rerun::ManagerStep step;
    step.Events.emplace_back();
    const std::string text = Rerun::TextOf(step);
    for (std::size_t size = 0; size < text.size(); ++size)
    {
        EXPECT_FALSE(Rerun::StepOf(text.substr(0, size))) << size;
    }
    for (
        const char *wrong :
        {"[]", "{}", "17", "null",
         R"({"step":"sleep","number":"1","monotonic_ns":"1","gps_time_s":1,"events":[]})",
         R"({"step":"startup","number":"x","monotonic_ns":"1","gps_time_s":1,"events":[]})",
         R"({"step":"startup","number":"1","monotonic_ns":"1","gps_time_s":1,"events":[7]})",
         R"({"step":"startup","number":"1","monotonic_ns":"1","gps_time_s":1,"events":[{"what":"taken","name":"a","type":"b","sample":"0"}]})",
         R"({"step":"startup","number":"1","monotonic_ns":"1","gps_time_s":1,"events":[{"what":"taken","name":"a","type":"b","sample":"0g"}]})"})
    {
        EXPECT_FALSE(Rerun::StepOf(wrong)) << wrong;
    }
}

}  // namespace
}  // namespace Rabit
