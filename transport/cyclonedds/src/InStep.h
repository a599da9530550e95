/* In C, because the vendor's header of a domain's state does not compile as C++. */
#pragma once

#include <dds/ddsi/ddsi_guid.h>
#include <stdbool.h>

#ifdef __cplusplus
extern "C"
{
#endif

    /* Makes this host's best-effort readers follow a remote writer's samples. The vendor alone would lose the
       sample after each lost one (Eclipse Cyclone DDS, issue 1561). Returns true if they follow; otherwise
       call it again with the next sample. Call only from the cache of a reader that is given a sample of the
       writer. */
    bool RabitCycloneFollow(const ddsi_guid_t *writer);

#ifdef __cplusplus
}
#endif
