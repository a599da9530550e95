#pragma once

// Programs of earlier versions use boost::bind and boost::signals2 without including them: they come with
// PublishSubscribeMessage.h, RabitMessageQueue.h, RabitNonBlockingSPSCQueue.h and RabitManager.h. Without the
// two, a source that includes RabitManager.h takes a fifth less time to compile. A program that uses neither,
// or that includes what it uses, may define RABIT_LEAN_HEADERS for all of its sources, as the project itself
// does; nothing else changes.
#ifndef RABIT_LEAN_HEADERS
#include <boost/bind/bind.hpp>
#include <boost/signals2.hpp>
#endif

#include <boost/function.hpp>

namespace boost::signals2
{
template <typename Signature, typename SlotFunction>
class slot;
}

namespace Rabit
{

// A handler in the form that Boost.Signals2 takes. To make one, include <boost/signals2.hpp>.
using RabitBoostSlot = boost::signals2::slot<void(), boost::function<void()>>;

}  // namespace Rabit
