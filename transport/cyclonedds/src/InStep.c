#include "InStep.h"

#include <dds/ddsi/ddsi_domaingv.h>
#include <dds/ddsi/ddsi_entity_index.h>
#include <dds/ddsi/ddsi_entity_match.h>
#include <dds/ddsi/ddsi_proxy_endpoint.h>
#include <dds/ddsi/q_thread.h>

/* The vendor treats a reader as in step once three conditions hold: it follows the order of the writer's
 * samples, a heartbeat has come, and it has the earlier samples. The last two are for reliable readers alone,
 * and so are the heartbeats that the vendor reads. The lock is held. */
static void LetFollow(struct ddsi_proxy_writer *writer)
{
    if (!writer->have_seen_heartbeat)
    {
        writer->have_seen_heartbeat = 1;
    }
    ddsrt_avl_iter_t at;
    for (struct ddsi_pwr_rd_match *match =
             ddsrt_avl_iter_first(&ddsi_pwr_readers_treedef, &writer->readers, &at);
         match != NULL; match = ddsrt_avl_iter_next(&at))
    {
        if (match->in_sync != PRMSS_SYNC)
        {
            match->u.not_in_sync.end_of_tl_seq = 0;
        }
    }
}

bool RabitCycloneFollow(const ddsi_guid_t *writer)
{
    const struct ddsi_domaingv *domain = ddsrt_atomic_ldvoidp(&lookup_thread_state()->gv);
    struct ddsi_proxy_writer *known =
        domain == NULL ? NULL : entidx_lookup_proxy_writer_guid(domain->entity_index, writer);
    if (known == NULL)
    {
        return false;
    }
    /* The vendor delivers samples on the receiving thread with the lock held or, if its configuration says
     * so, on another thread without it. */
    const bool locks = !known->deliver_synchronously;
    if (locks)
    {
        ddsrt_mutex_lock(&known->e.lock);
    }
    const bool isDone = known->n_reliable_readers > 0 || known->n_readers_out_of_sync == 0;
    if (!isDone)
    {
        LetFollow(known);
    }
    if (locks)
    {
        ddsrt_mutex_unlock(&known->e.lock);
    }
    return isDone;
}
