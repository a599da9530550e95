// Runs the queue links on a simulated network, over many seeds. SeedRunner.h says how to call it.
#include "LinkSimulation.h"

#include <SeedRunner.h>

namespace
{

using Rabit::Sim::Figure;

Rabit::Sim::SeedResult Run(std::uint64_t seed, std::ostream *trace)
{
    const Rabit::Sim::SimResult result = Rabit::Sim::RunSeed(seed, trace);
    const Rabit::Sim::SimStatistics &s = result.Statistics;
    return {result.Failure,
            {{"events", s.Events},
             {"messages accepted", s.Accepted},
             {"refused (full)", s.Refused},
             {"delivered", s.Delivered},
             {"expired", s.Expired},
             {"in doubt", s.InDoubt},
             {"refused there", s.RefusedThere},
             {"delivered again (opted in)", s.DeliveredAgain},
             {"datagrams", s.Datagrams},
             {"datagrams lost", s.Lost},
             {"datagrams duplicated", s.Duplicated},
             {"datagrams straggling", s.Straggling},
             {"malformed datagrams", s.Malformed},
             {"thin media", s.ThinMedia},
             {"changes of a medium's rate", s.RateChanges},
             {"datagrams that overflowed a queue", s.Overflows},
             {"messages delivered in several parts", s.LargeDelivered},
             {"parts held by a receiver", s.PartsHeld},
             {"large messages prepared", s.Prepared},
             {"messages given up while the receiver was silent", s.GivenUp},
             {"bytes sent", s.BytesSent},
             {"bytes of messages delivered", s.PayloadDelivered},
             {"crashes", s.Crashes},
             {"storages lost", s.StoragesLost},
             {"incarnations raised", s.Raises},
             {"peers forgotten", s.Forgotten},
             {"most bytes sent, of what would do", s.MostSent, Figure::Kind::LargestPercent},
             {"longest drain", static_cast<std::uint64_t>(s.LongestDrain.count()), Figure::Kind::Largest}}};
}

}  // namespace

int main(int argc, char **argv)
{
    return Rabit::Sim::RunSeeds("link_simulation", argc, argv, Run);
}
