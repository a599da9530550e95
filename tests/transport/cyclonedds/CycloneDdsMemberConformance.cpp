// The conformance suite, between members of a fleet with keys.
#include <rabit/cyclonedds/CycloneDdsTransport.h>

#include "../conformance/ConformanceTest.h"
#include "../conformance/ProcessHarness.h"

namespace Rabit::Conformance
{

namespace
{

std::unique_ptr<TransportHarness> MakeCycloneDdsMembers()
{
    return std::make_unique<ProcessHarness>(std::make_unique<CycloneDdsTransport>(), "fleet");
}

}  // namespace

INSTANTIATE_TEST_SUITE_P(CycloneDdsMembers, Conformance,
                         testing::Values(HarnessMaker{"cyclonedds", &MakeCycloneDdsMembers}));

}  // namespace Rabit::Conformance
