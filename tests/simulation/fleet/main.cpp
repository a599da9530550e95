// Runs whole nodes on a simulated network, over many seeds. SeedRunner.h says how to call it.
#include "FleetSimulation.h"

#include <rabit/RabitLog.h>

int main(int argc, char **argv)
{
    // Refusals and peers that go are what this is about.
    Rabit::RabitLog::SetLevel(Rabit::RabitLogLevel::Off);
    return Rabit::Sim::RunSeeds("fleet_simulation", argc, argv, Rabit::Sim::RunFleetSeed);
}
