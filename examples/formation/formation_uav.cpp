// An aircraft of the formation. Its name is its place: uav1 to uav6.
#include "Aircraft.h"

#include <rabit/RabitLog.h>
#include <rabit/node/RunNode.h>

int main(int argc, char **argv)
{
    Rabit::RabitLog::SetLevel(Rabit::RabitLogLevel::Info);  // Leadership tells which aircraft leads
    Rabit::NodeProgram program;
    program.ConfigFile = "formation_uav.yaml";
    program.AddManagers = [](Rabit::RabitReactor &reactor, Rabit::GatewayConfig &config)
    {
        Formation::Settings settings;
        config.Parameters.Read("spacing_m", settings.SpacingM, 5, 200);
        config.Parameters.Read("cruise_mps", settings.CruiseMps, 0.5, 8);
        Rabit::RabitWorkspace &workspace = *Rabit::RabitWorkspace::GetWorkspace();
        reactor.AddManager(std::make_unique<Formation::Dynamics>(config.Node, settings, workspace));
        reactor.AddManager(std::make_unique<Formation::Keeper>(settings, config, workspace));
        reactor.AddManager(std::make_unique<Formation::Leadership>(config, workspace));
    };
    return Rabit::RunNode(argc, argv, program);
}
