#include "RemoteParticipant.h"

#include <dds/ddsi/ddsi_domaingv.h>
#include <dds/ddsi/ddsi_entity_index.h>
#include <dds/ddsi/ddsi_proxy_participant.h>
#include <dds/ddsi/q_addrset.h>
#include <dds/ddsi/q_lease.h>
#include <dds/ddsi/q_thread.h>
#include <dds/ddsrt/time.h>

static const struct ddsi_proxy_participant *Find(const ddsi_guid_t *participant)
{
    /* The vendor's thread that calls the listener works for one domain. */
    const struct ddsi_domaingv *domain = ddsrt_atomic_ldvoidp(&lookup_thread_state()->gv);
    return domain == NULL ? NULL : entidx_lookup_proxy_participant_guid(domain->entity_index, participant);
}

bool RabitCycloneLeaseHasExpired(const ddsi_guid_t *participant)
{
    const struct ddsi_proxy_participant *known = Find(participant);
    /* The lease that each message of the participant renews. */
    const struct lease *lease = known == NULL ? NULL : ddsrt_atomic_ldvoidp(&known->minl_auto);
    return lease != NULL && (int64_t)ddsrt_atomic_ld64(&lease->tend) <= ddsrt_time_elapsed().v;
}

struct Visit
{
    void (*found)(const struct RabitCyclonePlace *place, void *argument);
    void *argument;
};

static void VisitLocator(const ddsi_xlocator_t *locator, void *argument)
{
    const struct Visit *visit = argument;
    /* An IPv4 address is the last four of sixteen bytes; a multicast address begins with 224 to 239. */
    const unsigned char *address = locator->c.address + 12;
    if (locator->c.kind == NN_LOCATOR_KIND_UDPv4 && (address[0] & 0xf0) != 0xe0)
    {
        const struct RabitCyclonePlace place = {{address[0], address[1], address[2], address[3]},
                                                locator->c.port};
        visit->found(&place, visit->argument);
    }
}

void RabitCyclonePeerAddresses(const ddsi_guid_t *participant,
                               void (*found)(const struct RabitCyclonePlace *place, void *argument),
                               void *argument)
{
    const struct ddsi_proxy_participant *known = Find(participant);
    if (known != NULL)
    {
        struct Visit visit = {found, argument};
        addrset_forall(known->as_meta, VisitLocator, &visit);
        addrset_forall(known->as_default, VisitLocator, &visit);
    }
}

unsigned RabitCycloneMostInterfaces(void)
{
    return MAX_XMIT_CONNS;
}
