// A manager that is recorded, and run again: unchanged, and changed.
#include <rabit/ManualClock.h>
#include <rabit/RabitSteppedReactor.h>
#include <rabit/recording/ManagerRerun.h>
#include <rabit/recording/RecorderManager.h>

#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "consumer.idl.h"

namespace
{

class Sensor : public Rabit::RabitManager
{
public:
    Sensor(Rabit::RabitWorkspace &workspace, double gain) : RabitManager("Sensor", workspace), _gain(gain)
    {
        AddPublishSubscribeMessage("Reading", _reading);
        SetPeriodSec(0.5);
    }
    void ExecuteUnitOfWork() override
    {
        _reading->value = _gain * _reading->number++;
        _reading->PostMessage();
    }

private:
    const double _gain;
    const std::shared_ptr<Consumer::Reading> _reading = std::make_shared<Consumer::Reading>();
};

void Record(const std::string &folder)
{
    const auto clock = std::make_shared<Rabit::ManualClock>(1.4e9);
    Rabit::RabitWorkspace workspace(clock);
    Rabit::GatewayConfig config;
    config.Node = "a";
    config.Record.emplace();
    config.Record->Folder = folder;
    config.Record->Free = 0;
    config.Record->Steps = {"Sensor"};
    Rabit::RabitSteppedReactor reactor(workspace);
    reactor.AddManager(std::make_unique<Rabit::RecorderManager>(config, workspace));
    reactor.AddManager(std::make_unique<Sensor>(workspace, 2.0));
    reactor.Start();
    reactor.RunFor(*clock, std::chrono::milliseconds(4600));
    reactor.Stop();
}

}  // namespace

int main(int argc, char **argv)
{
    if (argc != 2)
    {
        return 2;
    }
    Record(argv[1]);
    std::vector<std::string> files;
    for (const auto &entry : std::filesystem::directory_iterator(argv[1]))
    {
        files.push_back(entry.path().string());
    }
    std::vector<std::string> problems;
    for (const auto &life : Rabit::ManagerRecording::Read(files, "Sensor", "a", problems))
    {
        for (const double gain : {2.0, 3.0})
        {
            const Rabit::RerunResult result =
                Rabit::ManagerRerun::Run(life, [gain](Rabit::RabitWorkspace &workspace)
                                         { return std::make_unique<Sensor>(workspace, gain); });
            if (result.Difference)
            {
                std::cout << result.Difference->ToString() << "\n";
            }
            else
            {
                std::cout << "as recorded: " << result.Steps << " steps, " << result.Outputs << " messages"
                          << result.Problem << "\n";
            }
        }
    }
    for (const std::string &problem : problems)
    {
        std::cout << problem << "\n";
    }
    return 0;
}
