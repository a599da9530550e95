/* In C, because the vendor's header of a domain's state does not compile as C++. */
#pragma once

#include <dds/ddsi/ddsi_guid.h>

#ifdef __cplusplus
extern "C"
{
#endif

    /* Calls found(address, argument) with each unicast IPv4 address, in network order, by which this domain
       reaches another participant; never for one that the vendor does not know. Call only from a listener of
       a built-in topic. */
    void RabitCyclonePeerAddresses(const ddsi_guid_t *participant,
                                   void (*found)(const unsigned char address[4], void *argument),
                                   void *argument);

    /* Number of network interfaces that one domain can use. */
    unsigned RabitCycloneMostInterfaces(void);

#ifdef __cplusplus
}
#endif
