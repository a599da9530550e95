/* Looks at the vendor's participants in a watched domain, and makes it announce one. */
#include "VendorMatch.h"
#include "VendorTraffic.h"

#include <dds/ddsi/ddsi_entity_index.h>
#include <dds/ddsi/ddsi_participant.h>
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
