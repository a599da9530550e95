/* In C, because the vendor's header of a domain's state does not compile as C++. */
#pragma once

#include <dds/ddsi/ddsi_guid.h>

#include <stdint.h>

#ifdef __cplusplus
extern "C"
{
#endif

    struct RabitCyclonePlace
    {
        unsigned char address[4]; /* IPv4, in network order */
        uint32_t port;
    };

    /* Calls found(place, argument) with each unicast address by which this domain reaches another
       participant; never for one that the vendor does not know. Call only from a listener of a built-in
       topic. */
    void RabitCyclonePeerAddresses(const ddsi_guid_t *participant,
                                   void (*found)(const struct RabitCyclonePlace *place, void *argument),
                                   void *argument);

    /* Number of network interfaces that one domain can use. */
    unsigned RabitCycloneMostInterfaces(void);

#ifdef __cplusplus
}
#endif
