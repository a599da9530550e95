/* Looks at the vendor's participants in a watched domain, and makes it announce, ask or forget one. */
#include "VendorMatch.h"
#include "VendorTraffic.h"

#include <dds/ddsi/ddsi_entity_index.h>
#include <dds/ddsi/ddsi_participant.h>
#include <dds/ddsi/ddsi_proxy_participant.h>
#include <dds/ddsi/q_rtps.h>
#include <dds/ddsi/q_thread.h>
#include <dds/ddsi/q_xevent.h>

void RabitCycloneAnnounce(const void *watch, const ddsi_guid_t *participant)
{
    struct ddsi_domaingv *domain = RabitCycloneDomainOf(watch);
    thread_state_awake(lookup_thread_state(), domain);
    struct ddsi_participant *known = entidx_lookup_participant_guid(domain->entity_index, participant);
    if (known != NULL)
    {
        ddsrt_mutex_lock(&known->e.lock);
        if (known->spdp_xevent != NULL)
        {
            resched_xevent_if_earlier(known->spdp_xevent, ddsrt_time_monotonic());
        }
        ddsrt_mutex_unlock(&known->e.lock);
    }
    thread_state_asleep(lookup_thread_state());
}

/* The own participant's writer of protected discovery. The vendor matches it with another participant's
 * reader when it has the keys of both, and accepts that reader's acknowledgements only with them. Between a
 * thread's awake and asleep. */
static struct ddsi_writer *ProtectedWriter(const struct ddsi_domaingv *domain, const ddsi_guid_t *own)
{
    ddsi_guid_t guid = *own;
    guid.entityid.u = NN_ENTITYID_SEDP_BUILTIN_PUBLICATIONS_SECURE_WRITER;
    return entidx_lookup_writer_guid(domain->entity_index, &guid);
}

bool RabitCycloneHasKeysOf(const void *watch, const ddsi_guid_t *own, const ddsi_guid_t *peer)
{
    struct ddsi_domaingv *domain = RabitCycloneDomainOf(watch);
    bool has = false;
    thread_state_awake(lookup_thread_state(), domain);
    struct ddsi_writer *known = ProtectedWriter(domain, own);
    if (known != NULL)
    {
        ddsrt_mutex_lock(&known->e.lock);
        const struct ddsi_wr_prd_match *const match = FindMatch(known, peer);
        /* A writer that has written nothing sends no heartbeat. */
        has = match != NULL && (match->has_replied_to_hb || known->seq == 0);
        ddsrt_mutex_unlock(&known->e.lock);
    }
    thread_state_asleep(lookup_thread_state());
    return has;
}

void RabitCycloneAsk(const void *watch, const ddsi_guid_t *own, const ddsi_guid_t *peer)
{
    struct ddsi_domaingv *domain = RabitCycloneDomainOf(watch);
    thread_state_awake(lookup_thread_state(), domain);
    struct ddsi_writer *known = ProtectedWriter(domain, own);
    if (known != NULL)
    {
        ddsrt_mutex_lock(&known->e.lock);
        struct ddsi_wr_prd_match *const match = FindMatch(known, peer);
        if (match != NULL && known->heartbeat_xevent != NULL)
        {
            match->has_replied_to_hb = 0;
            ddsrt_avl_augment_update(&ddsi_wr_readers_treedef, match);
            resched_xevent_if_earlier(known->heartbeat_xevent, ddsrt_time_monotonic());
        }
        ddsrt_mutex_unlock(&known->e.lock);
    }
    thread_state_asleep(lookup_thread_state());
}

void RabitCycloneForget(const void *watch, const ddsi_guid_t *peer)
{
    struct ddsi_domaingv *domain = RabitCycloneDomainOf(watch);
    thread_state_awake(lookup_thread_state(), domain);
    ddsi_delete_proxy_participant_by_guid(domain, peer, ddsrt_time_wallclock(), 0);
    thread_state_asleep(lookup_thread_state());
}

bool RabitCycloneIsUnheard(const void *watch, const ddsi_guid_t *participant)
{
    struct ddsi_domaingv *domain = RabitCycloneDomainOf(watch);
    ddsi_guid_t guid = *participant;
    guid.entityid.u = NN_ENTITYID_SEDP_BUILTIN_PUBLICATIONS_WRITER;
    bool unheard = false;
    thread_state_awake(lookup_thread_state(), domain);
    struct ddsi_writer *known = entidx_lookup_writer_guid(domain->entity_index, &guid);
    if (known != NULL)
    {
        ddsrt_mutex_lock(&known->e.lock);
        ddsrt_avl_iter_t at;
        for (const struct ddsi_wr_prd_match *match =
                 ddsrt_avl_iter_first(&ddsi_wr_readers_treedef, &known->readers, &at);
             match != NULL && !unheard; match = ddsrt_avl_iter_next(&at))
        {
            unheard = !match->has_replied_to_hb;
        }
        ddsrt_mutex_unlock(&known->e.lock);
    }
    thread_state_asleep(lookup_thread_state());
    return unheard;
}
