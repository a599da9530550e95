// A manager is recorded, and runs again with what it read.
#include <gtest/gtest.h>
#include <rabit/ManualClock.h>
#include <rabit/RabitManager.h>
#include <rabit/RabitReactor.h>
#include <rabit/RabitSteppedReactor.h>
#include <rabit/backfill/BackfillManager.h>
#include <rabit/recording/ManagerRerun.h>
#include <rabit/recording/RecorderManager.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "uav.idl.h"

namespace
{

using namespace std::chrono_literals;

class Battery : public Rabit::RabitManager
{
public:
    Battery(Rabit::RabitWorkspace &workspace, float percentPerSecond)
        : RabitManager("Battery", workspace), _percentPerSecond(percentPerSecond)
    {
        AddPublishSubscribeMessage("Health", _health);
        SetPeriodSec(1.0);
    }

    void ExecuteUnitOfWork() final
    {
        _used += _percentPerSecond;
        _health->battery_percent = 100 - _used;
        _health->PostMessage();
    }

private:
    const float _percentPerSecond;
    float _used = 0;
    const std::shared_ptr<Uav::Health> _health = std::make_shared<Uav::Health>();
};

// [record]
std::vector<std::string> RecordInto(const std::string &folder)
{
    const auto clock = std::make_shared<Rabit::ManualClock>(1.4e9);
    Rabit::RabitWorkspace workspace(clock);
    Rabit::GatewayConfig config;
    config.Node = "uav1";
    config.Record.emplace();
    config.Record->Folder = folder;
    config.Record->Free = 0;
    config.Record->Steps = {"Battery"};
    {
        Rabit::RabitSteppedReactor reactor(workspace);
        reactor.AddManager(std::make_unique<Rabit::RecorderManager>(config, workspace));  // before the others
        reactor.AddManager(std::make_unique<Battery>(workspace, 1.0F));
        reactor.Start();
        reactor.RunFor(*clock, 4500ms);
        reactor.Stop();
    }
    std::vector<std::string> files;
    for (const auto &entry : std::filesystem::directory_iterator(folder))
    {
        files.push_back(entry.path().string());
    }
    return files;
}
// [/record]

// [backfill]
// For a program that makes its managers by hand: RunNode does the same.
void AddRecorder(Rabit::GatewayConfig &config, Rabit::RabitReactor &reactor)
{
    Rabit::RecorderManager *recorder = nullptr;
    if (config.Record)
    {
        auto made = std::make_unique<Rabit::RecorderManager>(config);
        recorder = made.get();
        reactor.AddManager(std::move(made));
    }
    if (Rabit::BackfillManager::IsUsed(config))
    {
        reactor.AddManager(std::make_unique<Rabit::BackfillManager>(config, recorder));  // before the gateway
    }
}
// [/backfill]

TEST(RecordingExample, ANodeWithNothingToRecordNeedsNoManagerForIt)
{
    Rabit::GatewayConfig config;
    Rabit::RabitReactor reactor;
    AddRecorder(config, reactor);
    EXPECT_FALSE(Rabit::BackfillManager::IsUsed(config));
}

// [rerun]
TEST(RecordingExample, AManagerThatIsChangedDiffersFromItsRecording)
{
    const std::string folder = ::testing::TempDir() + "rabit-recording-" + std::to_string(::getpid());
    std::filesystem::create_directories(folder);
    std::vector<std::string> problems;
    const auto lives = Rabit::ManagerRecording::Read(RecordInto(folder), "Battery", "uav1", problems);
    ASSERT_EQ(lives.size(), 1u);

    const auto run = [&lives](float percentPerSecond)
    {
        return Rabit::ManagerRerun::Run(lives[0], [percentPerSecond](Rabit::RabitWorkspace &workspace)
                                        { return std::make_unique<Battery>(workspace, percentPerSecond); });
    };
    EXPECT_TRUE(run(1.0F).IsAlike());
    const Rabit::RerunResult changed = run(2.0F);
    ASSERT_TRUE(changed.Difference);
    EXPECT_EQ(changed.Difference->Field, "battery_percent");
    std::filesystem::remove_all(folder);
}
// [/rerun]

}  // namespace
