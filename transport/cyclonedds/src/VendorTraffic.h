/* In C, because the vendor's header of a domain's state is none for C++. */
#pragma once

#include <dds/ddsi/ddsi_guid.h>
#include <dds/ddsi/ddsi_sertype.h>

#include <stddef.h>

#ifdef __cplusplus
extern "C"
{
#endif

    /* Called, on any thread, for each datagram that was given to a socket: its beginning, up to RtpsHeadSize
       bytes, and its size. */
    typedef void (*RabitCycloneSent)(void *argument, const unsigned char *head, size_t headSize, size_t size);

    /* Watches the domain that this thread has just created, until it is deleted. NULL if that cannot be told.
       To be given to RabitCycloneUnwatch after the domain was deleted. */
    void *RabitCycloneWatch(RabitCycloneSent sent, void *argument);
    void RabitCycloneUnwatch(void *watch);

    /* What this thread writes, until RabitCycloneWriteToAll, goes to these participants alone, at their own
       addresses. Of more than four addresses that they have the rest is left out. */
    void RabitCycloneWriteTo(const struct ddsi_sertype *type, const ddsi_guid_t *participants, size_t count);
    void RabitCycloneWriteToAll(void);

    /* To how many addresses the vendor sends what this writer of a topic of that type writes. 0 if it does
     * not exist. */
    int RabitCycloneDestinations(const struct ddsi_sertype *type, const ddsi_guid_t *writer);

#ifdef __cplusplus
}
#endif
