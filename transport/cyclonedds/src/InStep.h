/* In C, because the vendor's header of a domain's state is none for C++. */
#pragma once

#include <dds/ddsi/ddsi_guid.h>
#include <stdbool.h>

#ifdef __cplusplus
extern "C"
{
#endif

    /* Has the best-effort readers that a writer elsewhere has here follow its samples. Left to the vendor,
       the sample that follows a lost one would be lost with it (Eclipse Cyclone DDS, issue 1561). Returns
       whether they do; else this is to be called with the next sample, too. Only from the cache of a reader
       that is given a sample of the writer. */
    bool RabitCycloneFollow(const ddsi_guid_t *writer);

#ifdef __cplusplus
}
#endif
