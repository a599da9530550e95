// Runs whole nodes on a simulated network, over many seeds. SeedRunner.h says how to call it.
#include "FleetSimulation.h"

#include <rabit/RabitLog.h>

int main(int argc, char **argv)
{
    // The runs are full of refusals and lost peers, so the log is off.
    Rabit::RabitLog::SetLevel(Rabit::RabitLogLevel::Off);
    return Rabit::Sim::RunSeeds("fleet_simulation", argc, argv, Rabit::Sim::RunFleetSeed);
}
