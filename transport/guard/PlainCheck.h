// Checks submessages that come without protection where DDS Security protects all else.
#pragma once

#include "guard/DeliveryCheck.h"

namespace Rabit::Rtps
{

// The writers with which Cyclone DDS would exchange descriptions of types. It sends their state unprotected,
// too; no node uses them.
bool IsOfTypes(EntityId writer);
// Submessages that nodes with keys accept unprotected.
bool IsHeardInPlain(const Submessage &submessage, const Delivery &delivery);
// True if a sample that ends something ends the sender itself, or an endpoint of its own.
// The endpoint or participant that a sound sample ends by a key alone; 0: none.
EntityId EndedBy(const Delivery &delivery);
bool EndsItsOwn(const Delivery &delivery, const GuidPrefix &sender);
// True if a submessage of a builtin writer is sound and of its sender, and no byte of it need be blanked.
bool IsSoundUnchanged(const Submessage &submessage, Delivery delivery, const GuidPrefix &sender);

}  // namespace Rabit::Rtps
