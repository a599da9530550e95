/* In C, because the vendor's header of a domain's state does not compile as C++. */
#pragma once

#include <dds/ddsi/ddsi_guid.h>
#include <dds/ddsi/ddsi_sertype.h>
#include <dds/ddsrt/iovec.h>

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "RemoteParticipant.h"

#ifdef __cplusplus
extern "C"
{
#endif

    /* Route from one of the vendor's sockets to an IPv4 address, or group. */
    struct RabitCycloneRoute
    {
        void *connection;
        unsigned char address[4];
        uint32_t port;
    };

    enum RabitCycloneTo
    {
        RabitCycloneToHost,
        RabitCycloneToSampleGroup
    };

    struct RabitCycloneWays
    {
        bool host;
        bool group;
    };

    /* A sealed datagram. */
    struct RabitCycloneSealed
    {
        const unsigned char *bytes;
        size_t size;
    };

    /* Calls made for each datagram, on any thread. A head is its beginning, up to 128 bytes. */
    struct RabitCycloneCalls
    {
        void *argument;
        /* isDiscovery: true if the datagram is of discovery. For these alone, `may` is called before sending.
           It returns true if the datagram may go that way now, and may change it in place. */
        bool (*isDiscovery)(const unsigned char *head, size_t headSize);
        bool (*may)(void *argument, unsigned char *datagram, size_t size,
                    const struct RabitCycloneRoute *route);
        /* holds: true if `hold` is to be called for this thread's datagrams. hold: true if it keeps the
           datagram to be sent later. */
        bool (*holds)(void);
        bool (*hold)(void *argument, const unsigned char *datagram, size_t size,
                     const struct RabitCycloneRoute *route);
        /* takes: true if this thread's datagrams of samples are to be passed to `take`, which keeps them,
           counts them, and sends them later by RabitCycloneSend. */
        bool (*takes)(void *argument);
        void (*take)(void *argument, const unsigned char *datagram, size_t size,
                     const struct RabitCycloneRoute *route, enum RabitCycloneTo to);
        /* Where a datagram of samples for that address alone goes: to the host, to the group of samples, or
           both. */
        struct RabitCycloneWays (*waysTo)(void *argument, const unsigned char *address);
        /* True if a datagram of that size may go to the address. If not, the vendor is told that it was
           sent. */
        bool (*mayGo)(void *argument, const struct RabitCyclonePlace *place, size_t size, bool samples);
        /* Seals a datagram, whose parts follow each other, for a place; for a group if `to` is NULL. The
           result is valid until this thread's next call. Its size is 0 if the datagram must not be sent.
           NULL: datagrams are sent as they are. */
        struct RabitCycloneSealed (*seal)(void *argument, const ddsrt_iovec_t *part, size_t parts,
                                          const struct RabitCyclonePlace *to);
        /* A datagram was given to a socket. `head`: before it was sealed; `size`: as the socket got it. */
        void (*sent)(void *argument, const unsigned char *head, size_t headSize, size_t size);
        /* A datagram was received, into a buffer of that capacity, where it may be changed in place. Returns
           the size of the part that the vendor may see; 0: nothing. `from`: the socket that sent it; NULL if
           unknown. `direct`: it was sent to us alone, for discovery. */
        size_t (*received)(void *argument, unsigned char *datagram, size_t size, size_t capacity,
                           const struct RabitCyclonePlace *from, bool direct);
    };

    /* Watches the domain that this thread has just created, until it is deleted. From then on the domain
       announces itself to groups, listed peers and hosts that were heard alone. NULL if that fails. Pass the
       result to RabitCycloneUnwatch after the domain was deleted. */
    void *RabitCycloneWatch(struct RabitCycloneCalls calls);
    void RabitCycloneUnwatch(void *watch);
    struct ddsi_domaingv *RabitCycloneDomainOf(const void *watch);
    /* Whether the domain's configuration has DDS Security. */
    bool RabitCycloneHasSecurity(const void *watch);
    /* Why datagrams may pass by the watch, as part of a sentence about the domain's configuration; NULL if
       none can. */
    const char *RabitCyclonePassesBy(const void *watch);

    /* Sends a datagram of ours that way or, as `to` says, from the same socket to the group of samples. Calls
       `seal`, but neither `may` nor `sent`. Returns the bytes that the socket got; 0: it got none. Valid
       until the domain is deleted. */
    size_t RabitCycloneSend(const void *watch, const struct RabitCycloneRoute *route, enum RabitCycloneTo to,
                            const unsigned char *datagram, size_t size);
    /* Sends a datagram as it is. Returns true if it was given to the socket. */
    bool RabitCycloneSendSealed(const void *watch, const struct RabitCycloneRoute *route,
                                const unsigned char *datagram, size_t size);
    /* The way to a place: from the socket of the interface on whose network the place is, or of the first. */
    struct RabitCycloneRoute RabitCycloneRouteTo(const void *watch, const struct RabitCyclonePlace *place);
    /* Calls found(route, argument) with each IPv4 way that the domain announces its participants, with a lock
       of the vendor's held. */
    void RabitCycloneAnnouncedRoutes(const void *watch,
                                     void (*found)(const struct RabitCycloneRoute *route, void *argument),
                                     void *argument);

    /* Sends one zero byte to the own discovery address, so that the receiving thread calls `received`. */
    void RabitCycloneWake(const void *watch);

    /* Announces an own participant of a watched domain to all, now. */
    void RabitCycloneAnnounce(const void *watch, const ddsi_guid_t *participant);
    /* True if a peer known to the participant has not answered yet the announcements of its writers, as a
       peer that knows us does. */
    bool RabitCycloneIsUnheard(const void *watch, const ddsi_guid_t *participant);

    /* Announces own participants at that address no more, unless it is one of the domain's listed peers. */
    void RabitCycloneAnnounceNoMoreTo(const void *watch, const struct RabitCyclonePlace *place);

    /* Until RabitCycloneWriteToAll, samples that this thread writes go to those of the participants alone
       that have readers of this writer, at the readers' own addresses. `type` is the type of the writer's
       topic. At most four addresses are used. */
    void RabitCycloneWriteTo(const struct ddsi_sertype *type, const ddsi_guid_t *writer,
                             const ddsi_guid_t *participants, size_t count);
    void RabitCycloneWriteToAll(void);

    /* Number of addresses to which the vendor sends samples of this writer; `type` is the type of its topic.
       0 if the writer does not exist. */
    int RabitCycloneDestinations(const struct ddsi_sertype *type, const ddsi_guid_t *writer);

#ifdef __cplusplus
}
#endif
