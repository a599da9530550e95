#include <rabit/simulated/SimulatedKeys.h>
#include <rabit/transport/Transport.h>

#include <cstdint>
#include <utility>

#include "NetworkCore.h"
#include "envelope/Member.h"
#include "envelope/NamedKeys.h"

namespace Rabit
{

SimulatedKeys::SimulatedKeys(const SimulatedNetwork &network, const std::string &fleet)
    : _core(network._core), _keys(std::make_unique<Envelope::NamedKeys>(fleet))
{
}

SimulatedKeys::~SimulatedKeys() = default;

std::shared_ptr<FleetMember> SimulatedKeys::Member(const std::string &node)
{
    constexpr std::int64_t withinAllDates = 1'800'000'000;
    Envelope::Member::Made made = Envelope::Member::Make(
        _keys->KeysOf(node), {.Steady = _core->ClockOfMembers(), .Utc = [] { return withinAllDates; }});
    if (made.Of == nullptr)
    {
        throw TransportError(made.Error, "security");
    }
    return std::move(made.Of);
}

}  // namespace Rabit
