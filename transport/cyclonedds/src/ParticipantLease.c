#include "ParticipantLease.h"

#include <dds/ddsi/ddsi_domaingv.h>
#include <dds/ddsi/ddsi_entity_index.h>
#include <dds/ddsi/ddsi_proxy_participant.h>
#include <dds/ddsi/q_lease.h>
#include <dds/ddsi/q_thread.h>
#include <dds/ddsrt/time.h>

bool RabitCycloneLeaseHasExpired(const ddsi_guid_t *participant)
{
    /* The vendor's thread that calls the listener works for one domain. */
    const struct ddsi_domaingv *domain = ddsrt_atomic_ldvoidp(&lookup_thread_state()->gv);
    if (domain == NULL)
    {
        return false;
    }
    const struct ddsi_proxy_participant *known =
        entidx_lookup_proxy_participant_guid(domain->entity_index, participant);
    if (known == NULL)
    {
        return false;
    }
    /* The lease that each message of the participant renews. */
    const struct lease *lease = ddsrt_atomic_ldvoidp(&known->minl_auto);
    return lease != NULL && (int64_t)ddsrt_atomic_ld64(&lease->tend) <= ddsrt_time_elapsed().v;
}
