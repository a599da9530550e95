#pragma once

namespace Rabit
{
class PublishSubscribeMessage;
class RabitMessage;

// A class of messages may have several types, which it tells apart in CopyMessage (DynamicMessage). Overrides
// of CopyMessage that return false for every message count as having copied. These functions run the user's
// Clone and CopyMessage.

// True if the message and the global copy are of one type.
bool IsSameType(PublishSubscribeMessage &global, RabitMessage &msg);
// Why `to.CopyMessage(from)` returned false: true if they are of different types.
bool IsRefusal(RabitMessage &to, RabitMessage &from);

}  // namespace Rabit
