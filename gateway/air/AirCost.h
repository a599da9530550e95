#pragma once

// The room foreign includes the header by this name.
#include <rabit/gateway/AirCost.h>
