#pragma once

// Either may be included first.
#include <rabit/PublishSubscribeClass.h>
#include <rabit/RabitBoost.h>
#include <rabit/RabitMessage.h>
