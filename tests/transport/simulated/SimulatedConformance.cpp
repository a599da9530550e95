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

}  // namespace

INSTANTIATE_TEST_SUITE_P(Simulated, Conformance,
                         testing::Values(HarnessMaker{"simulated", &MakeSimulatedHarness}));

}  // namespace Rabit::Conformance
