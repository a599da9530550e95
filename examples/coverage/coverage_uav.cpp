// An aircraft that covers an area together with others.
#include "Sweep.h"

#include <rabit/RabitLog.h>
#include <rabit/node/RunNode.h>

#include <memory>

int main(int argc, char **argv)
{
    Rabit::RabitLog::SetLevel(Rabit::RabitLogLevel::Info);  // Sweep tells of each cell
    Rabit::NodeProgram program;
    program.ConfigFile = "coverage.yaml";
    program.AddManagers = [](Rabit::RabitReactor &reactor, Rabit::GatewayConfig &config)
    {
        Coverage::Settings settings;
        config.Parameters.Read("cells", settings.Cells, 1, 63);
        config.Parameters.Read("seconds_per_cell", settings.SecondsPerCell, 0.2, 3600);
        reactor.AddManager(
            std::make_unique<Coverage::Sweep>(settings, config, *Rabit::RabitWorkspace::GetWorkspace()));
    };
    return Rabit::RunNode(argc, argv, program);
}
