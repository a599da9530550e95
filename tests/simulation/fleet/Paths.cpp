#include "Paths.h"

namespace Rabit::Sim
{

Paths::Paths(const FleetWorld &world, SimulatedNetwork &network, PresenceOracle &presence)
    : _world(world),
      _network(network),
      _presence(presence),
      _count(world.Plan.Machines.size()),
      _paths(_count * _count)
{
    for (std::size_t from = 0; from < _count; ++from)
    {
        for (std::size_t to = 0; to < _count; ++to)
        {
            SetWeather(from, to, world.Plan.Start[from * _count + to]);
        }
    }
}

void Paths::Apply(std::size_t from, std::size_t to)
{
    SimulatedFaults faults = At(from, to).Weather;
    faults.Cut = At(from, to).Cuts > 0;
    _network.SetFaults(_world.NameOf(from), _world.NameOf(to), faults);
}

void Paths::SetWeather(std::size_t from, std::size_t to, const SimulatedFaults &weather)
{
    At(from, to).Weather = weather;
    Apply(from, to);
}

void Paths::Cut(std::size_t from, std::size_t to)
{
    ++_cuts;
    ++At(from, to).Cuts;
    _presence.OnCut(from, to);
    Apply(from, to);
}

void Paths::EndCut(std::size_t from, std::size_t to)
{
    --At(from, to).Cuts;
    _presence.OnCutEnd(from, to);
    Apply(from, to);
}

void Paths::CutAll()
{
    for (std::size_t i = 0; i < _count * _count; ++i)
    {
        Cut(i / _count, i % _count);
    }
}

void Paths::EndCutOfAll()
{
    for (std::size_t i = 0; i < _count * _count; ++i)
    {
        EndCut(i / _count, i % _count);
    }
}

}  // namespace Rabit::Sim
