#pragma once

// Either may be included first.
#include <rabit/PublishSubscribeClass.h>
#include <rabit/RabitMessage.h>

#include <boost/bind/bind.hpp>
#include <boost/function.hpp>
#include <boost/signals2.hpp>
