/* Other participants, as the vendor knows them. In C, because the vendor's header of a domain's state does
   not compile as C++. Call the first two only from a listener of a built-in topic. */
#pragma once

#include <dds/ddsi/ddsi_guid.h>
#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C"
{
#endif

    /* True if the participant's lease has run out: it sent nothing for that long. False for one that the
       vendor does not know. In a listener the vendor reports, without a reason, that a participant is gone,
       and still has its entry. */
    bool RabitCycloneLeaseHasExpired(const ddsi_guid_t *participant);

    struct RabitCyclonePlace
    {
        unsigned char address[4]; /* IPv4, in network order */
        uint32_t port;
    };

    /* Calls found(place, argument) with each unicast address by which this domain reaches the participant;
       never for one that the vendor does not know. */
    void RabitCyclonePeerAddresses(const ddsi_guid_t *participant,
                                   void (*found)(const struct RabitCyclonePlace *place, void *argument),
                                   void *argument);

    /* Number of network interfaces that one domain can use. */
    unsigned RabitCycloneMostInterfaces(void);

#ifdef __cplusplus
}
#endif
