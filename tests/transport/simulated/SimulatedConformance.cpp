#include "../conformance/ConformanceTest.h"
#include "SimulatedHarness.h"

namespace Rabit::Conformance
{

namespace
{

std::unique_ptr<TransportHarness> MakeSimulatedHarness()
{
    return std::make_unique<SimulatedHarness>();
}

std::unique_ptr<TransportHarness> MakeSimulatedMembers()
{
    return std::make_unique<SimulatedHarness>(1, "fleet");
}

}  // namespace

INSTANTIATE_TEST_SUITE_P(Simulated, Conformance,
                         testing::Values(HarnessMaker{"simulated", &MakeSimulatedHarness}));
INSTANTIATE_TEST_SUITE_P(SimulatedMembers, Conformance,
                         testing::Values(HarnessMaker{"simulated", &MakeSimulatedMembers}));

}  // namespace Rabit::Conformance
