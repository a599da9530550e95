// The ground program of the formation.
#include "Director.h"

#include <rabit/node/RunNode.h>

int main(int argc, char **argv)
{
    Rabit::NodeProgram program;
    program.ConfigFile = "formation_ground.yaml";
    program.AddManagers = [](Rabit::RabitReactor &reactor, Rabit::GatewayConfig &config)
    {
        int aircraft = 6;
        double legM = 200;
        Formation::Settings settings;
        config.Parameters.Read("aircraft", aircraft, 1, 100);
        config.Parameters.Read("leg_m", legM, 10, 10'000);
        config.Parameters.Read("spacing_m", settings.SpacingM, 5, 200);
        reactor.AddManager(std::make_unique<Formation::Director>(aircraft, legM, settings.SpacingM, config,
                                                                 *Rabit::RabitWorkspace::GetWorkspace()));
    };
    return Rabit::RunNode(argc, argv, program);
}
