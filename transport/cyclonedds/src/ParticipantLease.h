/* In C, because the vendor's header of a domain's state is none for C++. */
#pragma once

#include <dds/ddsi/ddsi_guid.h>
#include <stdbool.h>

#ifdef __cplusplus
extern "C"
{
#endif

    /* Whether the lease of another participant has run out, that is, whether it said nothing for that long;
       false for one that the vendor does not know. Only from a listener of a built-in topic: the vendor tells
       there that a participant is gone while it still has it in its books, but does not tell why. */
    bool RabitCycloneLeaseHasExpired(const ddsi_guid_t *participant);

#ifdef __cplusplus
}
#endif
