/* In C, because the vendor's header of a domain's state does not compile as C++. */
#pragma once

#include <dds/ddsi/ddsi_guid.h>
#include <stdbool.h>

#ifdef __cplusplus
extern "C"
{
#endif

    /* True if another participant's lease has run out: it sent nothing for that long. False for one that the
       vendor does not know. Call only from a listener of a built-in topic. There the vendor reports, without
       a reason, that a participant is gone, and still has its entry. */
    bool RabitCycloneLeaseHasExpired(const ddsi_guid_t *participant);

#ifdef __cplusplus
}
#endif
