#include <rabit/fastdds/FastDdsTransport.h>

#include "../conformance/ConformanceTest.h"
#include "../conformance/ProcessHarness.h"

namespace Rabit::Conformance
{

namespace
{

std::unique_ptr<TransportHarness> MakeFastDdsHarness()
{
    return std::make_unique<ProcessHarness>(std::make_unique<FastDdsTransport>());
}

std::unique_ptr<TransportHarness> MakeFastDdsMembers()
{
    return std::make_unique<ProcessHarness>(std::make_unique<FastDdsTransport>(), "fleet");
}

}  // namespace

INSTANTIATE_TEST_SUITE_P(FastDds, Conformance, testing::Values(HarnessMaker{"fastdds", &MakeFastDdsHarness}));
INSTANTIATE_TEST_SUITE_P(FastDdsMembers, Conformance,
                         testing::Values(HarnessMaker{"fastdds", &MakeFastDdsMembers}));

}  // namespace Rabit::Conformance
