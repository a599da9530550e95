// The base of the suite NetworkSettings: the meaning of the settings that only a real network has, the same
// for every backend that has one.
//
// A backend joins by an own test program that links rabit_transport_network_settings and says
//   INSTANTIATE_TEST_SUITE_P(Its, NetworkSettings, testing::Values(HarnessMaker{"its name", &Make}));
#pragma once

#include <gtest/gtest.h>

#include "NetworkFixture.h"

namespace Rabit::Conformance
{

class NetworkSettings : public testing::TestWithParam<HarnessMaker>, protected NetworkFixture
{
protected:
    NetworkSettings() : NetworkFixture(GetParam().Make()) {}
};

}  // namespace Rabit::Conformance
