#include "VendorTraffic.h"

#include <dds/ddsi/ddsi_domaingv.h>
#include <dds/ddsi/ddsi_entity.h>
/* The next needs the one before. */
#include <dds/ddsi/ddsi_endpoint.h>
#include <dds/ddsi/ddsi_entity_index.h>
#include <dds/ddsi/ddsi_proxy_participant.h>
#include <dds/ddsi/ddsi_tran.h>
#include <dds/ddsi/q_addrset.h>
#include <dds/ddsi/q_thread.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

enum
{
    HeadSize = 128, /* RtpsHeadSize */
    MostTargets = 4
};

/* A domain whose sockets write through WriteAndTell. */
struct Watch
{
    const struct ddsi_domaingv *domain;
    ddsi_tran_write_fn_t write;
    RabitCycloneSent sent;
    void *argument;
    struct Watch *next;
};

static pthread_rwlock_t lock = PTHREAD_RWLOCK_INITIALIZER;
static struct Watch *first = NULL; /* guarded by lock */

/* What the thread that writes is to send to. */
struct Targets
{
    bool chosen;
    size_t count;
    ddsi_xlocator_t at[MostTargets];
};

static _Thread_local struct Targets targets;

static struct Watch Find(const struct ddsi_domaingv *domain)
{
    struct Watch found = {NULL, NULL, NULL, NULL, NULL};
    pthread_rwlock_rdlock(&lock);
    for (const struct Watch *watch = first; watch != NULL; watch = watch->next)
    {
        if (watch->domain == domain)
        {
            found = *watch;
            break;
        }
    }
    pthread_rwlock_unlock(&lock);
    return found;
}

static ssize_t WriteOne(ddsi_tran_conn_t connection, const ddsi_locator_t *destination, size_t parts,
                        const ddsrt_iovec_t *part, uint32_t flags)
{
    /* It is there as long as its sockets are. */
    const struct Watch watch = Find(connection->m_base.gv);
    if (watch.write == NULL)
    {
        return -1;
    }
    const ssize_t size = watch.write(connection, destination, parts, part, flags);
    if (size > 0)
    {
        unsigned char head[HeadSize];
        size_t filled = 0;
        for (size_t i = 0; i < parts && filled < sizeof head; ++i)
        {
            const size_t left = sizeof head - filled;
            const size_t taken = part[i].iov_len < left ? part[i].iov_len : left;
            memcpy(head + filled, part[i].iov_base, taken);
            filled += taken;
        }
        watch.sent(watch.argument, head, filled, (size_t)size);
    }
    return size;
}

static bool IsGroup(const ddsi_locator_t *locator)
{
    /* An IPv4 address is the last four of sixteen bytes; the first of a multicast one is 224 to 239. */
    return (locator->address[12] & 0xf0) == 0xe0;
}

static bool IsSame(const ddsi_locator_t *one, const ddsi_locator_t *other)
{
    return one->kind == other->kind && one->port == other->port &&
           memcmp(one->address, other->address, sizeof one->address) == 0;
}

/* The vendor sends a sample of a writer without delay on the thread that writes it, to the group or to each
 * reader. */
static ssize_t WriteAndTell(ddsi_tran_conn_t connection, const ddsi_locator_t *destination, size_t parts,
                            const ddsrt_iovec_t *part, uint32_t flags)
{
    if (!targets.chosen)
    {
        return WriteOne(connection, destination, parts, part, flags);
    }
    ssize_t size = 0;
    for (size_t i = 0; i < parts; ++i)
    {
        size += (ssize_t)part[i].iov_len;
    }
    const bool isGroup = IsGroup(destination);
    for (size_t i = 0; i < targets.count; ++i)
    {
        const ddsi_xlocator_t *target = &targets.at[i];
        if (target->conn == connection && (isGroup || IsSame(&target->c, destination)))
        {
            WriteOne(connection, &target->c, parts, part, flags);
        }
    }
    return size;
}

static void AddTarget(const ddsi_xlocator_t *locator, void *argument)
{
    (void)argument;
    bool known = locator->c.kind != NN_LOCATOR_KIND_UDPv4 || IsGroup(&locator->c);
    for (size_t i = 0; i < targets.count; ++i)
    {
        known = known || (targets.at[i].conn == locator->conn && IsSame(&targets.at[i].c, &locator->c));
    }
    if (!known && targets.count < MostTargets)
    {
        targets.at[targets.count++] = *locator;
    }
}

void RabitCycloneWriteTo(const struct ddsi_sertype *type, const ddsi_guid_t *participants, size_t count)
{
    struct ddsi_domaingv *domain = ddsrt_atomic_ldvoidp(&type->gv);
    targets.chosen = true;
    targets.count = 0;
    if (domain == NULL)
    {
        return;
    }
    thread_state_awake(lookup_thread_state(), domain);
    for (size_t i = 0; i < count; ++i)
    {
        const struct ddsi_proxy_participant *known =
            entidx_lookup_proxy_participant_guid(domain->entity_index, &participants[i]);
        if (known != NULL)
        {
            addrset_forall(known->as_default, AddTarget, NULL);
        }
    }
    thread_state_asleep(lookup_thread_state());
}

void RabitCycloneWriteToAll(void)
{
    targets.chosen = false;
}

void *RabitCycloneWatch(RabitCycloneSent sent, void *argument)
{
    struct ddsi_domaingv *domain = ddsrt_atomic_ldvoidp(&lookup_thread_state()->gv);
    struct Watch *watch = domain == NULL || domain->n_interfaces < 1 ? NULL : malloc(sizeof *watch);
    if (watch == NULL)
    {
        return NULL;
    }
    watch->domain = domain;
    watch->write = domain->xmit_conns[0]->m_write_fn;
    watch->sent = sent;
    watch->argument = argument;
    pthread_rwlock_wrlock(&lock);
    watch->next = first;
    first = watch;
    pthread_rwlock_unlock(&lock);
    /* Nothing is sent before there is a participant. */
    for (int i = 0; i < domain->n_interfaces; ++i)
    {
        if (domain->xmit_conns[i]->m_write_fn == watch->write)
        {
            domain->xmit_conns[i]->m_write_fn = WriteAndTell;
        }
    }
    return watch;
}

void RabitCycloneUnwatch(void *watch)
{
    pthread_rwlock_wrlock(&lock);
    for (struct Watch **link = &first; *link != NULL; link = &(*link)->next)
    {
        if (*link == watch)
        {
            *link = (*link)->next;
            break;
        }
    }
    pthread_rwlock_unlock(&lock);
    free(watch);
}

static void Count(const ddsi_xlocator_t *locator, void *argument)
{
    (void)locator;
    ++*(int *)argument;
}

int RabitCycloneDestinations(const struct ddsi_sertype *type, const ddsi_guid_t *writer)
{
    struct ddsi_domaingv *domain = ddsrt_atomic_ldvoidp(&type->gv);
    int count = 0;
    if (domain == NULL)
    {
        return 0;
    }
    thread_state_awake(lookup_thread_state(), domain);
    struct ddsi_writer *known = entidx_lookup_writer_guid(domain->entity_index, writer);
    if (known != NULL)
    {
        ddsrt_mutex_lock(&known->e.lock);
        if (known->as != NULL)
        {
            addrset_forall(known->as, Count, &count);
        }
        ddsrt_mutex_unlock(&known->e.lock);
    }
    thread_state_asleep(lookup_thread_state());
    return count;
}
