// Two nodes on a simulated network: prints the state of one as the other sees it.
#include <rabit/testing/SimulatedFleet.h>

#include <chrono>
#include <iostream>

int main()
{
    Rabit::SimulatedFleet fleet;
    for (const char *name : {"one", "two"})
    {
        Rabit::GatewayConfig config;
        config.Node = name;
        fleet.Add(config);
    }
    fleet.RunFor(std::chrono::seconds(3));
    std::cout << fleet["one"].StateOf("two") << '\n';
}
