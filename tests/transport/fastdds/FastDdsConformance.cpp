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

}  // namespace

INSTANTIATE_TEST_SUITE_P(FastDds, Conformance, testing::Values(HarnessMaker{"fastdds", &MakeFastDdsHarness}));

}  // namespace Rabit::Conformance
