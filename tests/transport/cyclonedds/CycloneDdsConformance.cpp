#include <rabit/cyclonedds/CycloneDdsTransport.h>

#include "../conformance/ConformanceTest.h"
#include "../conformance/ProcessHarness.h"

namespace Rabit::Conformance
{

namespace
{

std::unique_ptr<TransportHarness> MakeCycloneDdsHarness()
{
    return std::make_unique<ProcessHarness>(std::make_unique<CycloneDdsTransport>());
}

}  // namespace

INSTANTIATE_TEST_SUITE_P(CycloneDds, Conformance,
                         testing::Values(HarnessMaker{"cyclonedds", &MakeCycloneDdsHarness}));

}  // namespace Rabit::Conformance
