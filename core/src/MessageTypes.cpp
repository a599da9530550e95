#include "MessageTypes.h"

#include <rabit/PublishSubscribeClass.h>
#include <rabit/RabitManagerTrace.h>
#include <rabit/RabitMessage.h>

namespace Rabit
{

bool IsSameType(PublishSubscribeMessage &global, RabitMessage &msg)
{
    if (global.MsgTypeIndex() != msg.GetTypeIndex())
    {
        return false;
    }
    const RabitManagerTrace::Pause trace;  // nothing is fetched
    const auto held = global.GetCopyOfMessage();
    const auto copy = msg.Clone();
    return !held || !copy || copy->CopyMessage(held.get()) || !IsRefusal(*copy, *held);
}

bool IsRefusal(RabitMessage &to, RabitMessage &from)
{
    if (to.GetTypeIndex() != from.GetTypeIndex())
    {
        return true;
    }
    const auto own = to.Clone();
    return own && own->CopyMessage(&to);
}

}  // namespace Rabit
