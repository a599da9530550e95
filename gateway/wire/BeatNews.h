#pragma once

#include "gateway.idl.h"

namespace Rabit
{

// The optional news of a beat; empty if it has none.
const Gateway::BeatNews &NewsOf(const Gateway::Beat &beat);
// The same, to be added to.
Gateway::BeatNews &NewsOf(Gateway::Beat &beat);
// Leaves the news out if they are empty, so that they take no room on the wire.
void DropEmptyNews(Gateway::Beat &beat);

}  // namespace Rabit
