// The second tutorial: two managers, one that reads lines and one that prints them.
#include "PrintManager.h"
#include "ReadManager.h"

#include <rabit/RabitReactor.h>

#include <CLI/CLI.hpp>

#include <memory>

int main(int argc, char **argv)
{
    PrintManager::Options options;
    CLI::App app(
        "Prints the lines it reads: posted ones, and those that start with \"queue\" by way of a queue.");
    app.add_option("--period", options.Period_Sec,
                   "Seconds between two prints if nothing wakes the printing manager")
        ->capture_default_str()
        ->check(CLI::PositiveNumber);
    app.add_flag("--wake-on-post", options.WakeOnPost, "Print each posted line at once");
    app.add_flag("!--no-wake-on-queue", options.WakeOnQueue, "Let queued lines wait for the timer");
    CLI11_PARSE(app, argc, argv);

    Rabit::RabitReactor reactor;
    reactor.AddManager(std::make_unique<PrintManager>(options));
    reactor.AddManager(std::make_unique<ReadManager>());
    reactor.Run();
    return 0;
}
