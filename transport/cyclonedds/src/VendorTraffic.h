/* In C, because the vendor's header of a domain's state is none for C++. */
#pragma once

#include <dds/ddsi/ddsi_guid.h>
#include <dds/ddsi/ddsi_sertype.h>

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C"
{
#endif

    /* From one of the vendor's sockets to an IPv4 address, or group. */
    struct RabitCycloneRoute
    {
        void *connection;
        unsigned char address[4];
        uint32_t port;
    };

    enum RabitCycloneTo
    {
        RabitCycloneToHost,
        RabitCycloneToDiscoveryGroup,
        RabitCycloneToSampleGroup
    };

    struct RabitCycloneWays
    {
        bool host;
        bool group;
    };

    /* What is called for each datagram, on any thread. A head is its beginning, up to RtpsHeadSize bytes. */
    struct RabitCycloneCalls
    {
        void *argument;
        /* Whether it is of discovery. These alone are asked about before they are sent: whether one may go
           that way now, and what of it, which is changed in place. */
        bool (*isDiscovery)(const unsigned char *head, size_t headSize);
        bool (*may)(void *argument, unsigned char *datagram, size_t size,
                    const struct RabitCycloneRoute *route);
        /* Whether datagrams that this thread sends now are asked about by hold: whether one waits for its
           turn instead of being sent. */
        bool (*holds)(void);
        bool (*hold)(void *argument, const unsigned char *datagram, size_t size,
                     const struct RabitCycloneRoute *route);
        /* Where a datagram of samples goes that is for that address alone: to it, and to the group of
         * samples? */
        struct RabitCycloneWays (*waysTo)(void *argument, const unsigned char *address);
        /* It was given to a socket. */
        void (*sent)(void *argument, const unsigned char *head, size_t headSize, size_t size);
        /* It came, into a buffer of that capacity, in which it may be changed in place. Returns how long what
           the vendor may see of it is; 0 if nothing. `from` is NULL if that is not known. `direct`: it was
           sent to us alone, for discovery. */
        size_t (*received)(void *argument, unsigned char *datagram, size_t size, size_t capacity,
                           const unsigned char *from, bool direct);
    };

    /* Watches the domain that this thread has just created, until it is deleted. NULL if that cannot be told.
       To be given to RabitCycloneUnwatch after the domain was deleted. */
    void *RabitCycloneWatch(struct RabitCycloneCalls calls);
    void RabitCycloneUnwatch(void *watch);

    /* Sends a datagram of ours that way, without asking whether it may go, or from the same socket to the
       group of discovery. Until the domain is deleted. */
    void RabitCycloneSend(const void *watch, const struct RabitCycloneRoute *route, enum RabitCycloneTo to,
                          const unsigned char *datagram, size_t size);

    /* Sends one zero byte to the own address of discovery, so that a receiving thread calls `received`. */
    void RabitCycloneWake(const void *watch);

    /* Announces an own participant of a domain that is watched to all, now. */
    void RabitCycloneAnnounce(const void *watch, const ddsi_guid_t *participant);
    /* Whether somebody whom it knows has not answered yet what it said of its writers: whoever knows us does.
     */
    bool RabitCycloneIsUnheard(const void *watch, const ddsi_guid_t *participant);

    /* What this thread writes, until RabitCycloneWriteToAll, goes to those of these participants alone that
       have readers of this writer of a topic of that type, at their own addresses. Of more than four
       addresses that they have the rest is left out. */
    void RabitCycloneWriteTo(const struct ddsi_sertype *type, const ddsi_guid_t *writer,
                             const ddsi_guid_t *participants, size_t count);
    void RabitCycloneWriteToAll(void);

    /* To how many addresses the vendor sends what this writer of a topic of that type writes. 0 if it does
     * not exist. */
    int RabitCycloneDestinations(const struct ddsi_sertype *type, const ddsi_guid_t *writer);

#ifdef __cplusplus
}
#endif
