#include "VendorTraffic.h"

#include "VendorMatch.h"

#include <arpa/inet.h>
#include <dds/ddsi/ddsi_entity_index.h>
#include <dds/ddsi/ddsi_tran.h>
#include <dds/ddsi/q_addrset.h>
#include <dds/ddsi/q_rtps.h>
#include <dds/ddsi/q_thread.h>
#include <dds/ddsrt/time.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

enum
{
    HeadSize = 128, /* more than IsOfSamples (common/RtpsTraffic.h) inspects */
    MostOfDiscovery = 4096,
    AddressAt = 12, /* an IPv4 address is the last four of sixteen bytes */
    MostTargets = 4,
    RtpsHeaderSize = 20,
    PrefixSize = 12,
    MostParts = 64
};

/* The beginning of an INFO_DST submessage, whose prefix follows (OMG DDSI-RTPS 2.3, 9.4.5.7). */
static const unsigned char InfoDestination[] = {0x0e, 0x01, PrefixSize, 0};

/* A domain whose sockets write through WriteAndTell and read through ReadAndTell. */
struct Watch
{
    struct ddsi_domaingv *domain;
    ddsi_tran_write_fn_t write;
    ddsi_tran_read_fn_t read;
    struct RabitCycloneCalls calls;
    struct addrset *listed; /* where the domain announces itself without having heard anybody */
    struct Watch *next;
};

static pthread_rwlock_t lock = PTHREAD_RWLOCK_INITIALIZER;
static struct Watch *first = NULL; /* guarded by lock */

/* Destinations of the samples that this thread writes. */
struct Targets
{
    bool chosen;
    size_t count;
    ddsi_xlocator_t at[MostTargets];
    unsigned char prefix[MostTargets][PrefixSize]; /* of whose address it is, as on the wire */
};

static _Thread_local struct Targets targets;

static struct Watch Find(const struct ddsi_domaingv *domain)
{
    struct Watch found;
    memset(&found, 0, sizeof found);
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

/* Copies at most `size` of the bytes to be written; returns how many. */
static size_t Gather(unsigned char *buffer, size_t size, size_t parts, const ddsrt_iovec_t *part)
{
    size_t filled = 0;
    for (size_t i = 0; i < parts && filled < size; ++i)
    {
        const size_t left = size - filled;
        const size_t taken = part[i].iov_len < left ? part[i].iov_len : left;
        memcpy(buffer + filled, part[i].iov_base, taken);
        filled += taken;
    }
    return filled;
}

static size_t SizeOf(size_t parts, const ddsrt_iovec_t *part)
{
    size_t size = 0;
    for (size_t i = 0; i < parts; ++i)
    {
        size += part[i].iov_len;
    }
    return size;
}

static struct RabitCyclonePlace PlaceOf(const ddsi_locator_t *locator)
{
    struct RabitCyclonePlace place = {.port = locator->port};
    memcpy(place.address, locator->address + AddressAt, sizeof place.address);
    return place;
}

static bool IsGroup(const ddsi_locator_t *locator)
{
    /* The first byte of a multicast address is 224 to 239. */
    return (locator->address[AddressAt] & 0xf0) == 0xe0;
}

/* The vendor and RabitCycloneWake wake a thread by one zero byte. */
static bool IsWakeUp(size_t parts, const ddsrt_iovec_t *part)
{
    return parts == 1 && part[0].iov_len == 1 && *(const unsigned char *)part[0].iov_base == 0;
}

/* Gives a datagram to a socket, sealed if the session has keys. Returns the bytes that the socket got; 0: the
 * datagram must not be sent. */
static ssize_t Give(const struct Watch *watch, ddsi_tran_conn_t connection, const ddsi_locator_t *destination,
                    size_t parts, const ddsrt_iovec_t *part, uint32_t flags)
{
    if (watch->calls.seal == NULL || IsWakeUp(parts, part))
    {
        return watch->write(connection, destination, parts, part, flags);
    }
    if (destination->kind != NN_LOCATOR_KIND_UDPv4)
    {
        return 0;
    }
    const struct RabitCyclonePlace place = PlaceOf(destination);
    const struct RabitCycloneSealed sealed =
        watch->calls.seal(watch->calls.argument, part, parts, IsGroup(destination) ? NULL : &place);
    const ddsrt_iovec_t whole = {(void *)sealed.bytes, sealed.size};
    return sealed.size == 0 ? 0 : watch->write(connection, destination, 1, &whole, flags);
}

static bool MayGo(const struct Watch *watch, const ddsi_locator_t *destination, size_t size, bool samples)
{
    const struct RabitCyclonePlace place = PlaceOf(destination);
    return destination->kind != NN_LOCATOR_KIND_UDPv4 ||
           watch->calls.mayGo(watch->calls.argument, &place, size, samples);
}

static struct RabitCycloneRoute RouteTo(ddsi_tran_conn_t connection, const ddsi_locator_t *destination)
{
    struct RabitCycloneRoute route = {.connection = connection, .port = destination->port};
    memcpy(route.address, destination->address + AddressAt, sizeof route.address);
    return route;
}

/* Returns a copy of the datagram, to be freed; NULL if there is no memory. */
static unsigned char *CopyOf(size_t size, size_t parts, const ddsrt_iovec_t *part)
{
    unsigned char *const datagram = malloc(size);
    if (datagram != NULL)
    {
        Gather(datagram, size, parts, part);
    }
    return datagram;
}

static ssize_t WriteDiscovery(const struct Watch *watch, ddsi_tran_conn_t connection,
                              const ddsi_locator_t *destination, size_t parts, const ddsrt_iovec_t *part,
                              uint32_t flags)
{
    unsigned char datagram[MostOfDiscovery];
    const size_t size = SizeOf(parts, part);
    if (size > sizeof datagram)
    {
        return MayGo(watch, destination, size, false)
                   ? Give(watch, connection, destination, parts, part, flags)
                   : 0;
    }
    const ddsrt_iovec_t whole = {datagram, Gather(datagram, sizeof datagram, parts, part)};
    const struct RabitCycloneRoute route = RouteTo(connection, destination);
    if (!watch->calls.may(watch->calls.argument, datagram, size, &route) ||
        !MayGo(watch, destination, size, false))
    {
        return 0;
    }
    return Give(watch, connection, destination, 1, &whole, flags);
}

/* Returns true if the datagram is held. */
static bool Hold(const struct Watch *watch, ddsi_tran_conn_t connection, const ddsi_locator_t *destination,
                 size_t parts, const ddsrt_iovec_t *part)
{
    if (!watch->calls.holds() || destination->kind != NN_LOCATOR_KIND_UDPv4)
    {
        return false;
    }
    const size_t size = SizeOf(parts, part);
    unsigned char *const datagram = CopyOf(size, parts, part);
    const struct RabitCycloneRoute route = RouteTo(connection, destination);
    const bool held = datagram != NULL && watch->calls.hold(watch->calls.argument, datagram, size, &route);
    free(datagram);
    return held;
}

/* Sends a datagram of samples, or keeps it for the end of this thread's turn. Returns the bytes that were
 * sent or kept. */
static ssize_t WriteSamples(const struct Watch *watch, ddsi_tran_conn_t connection,
                            const ddsi_locator_t *destination, enum RabitCycloneTo to, size_t parts,
                            const ddsrt_iovec_t *part, uint32_t flags, const unsigned char *head,
                            size_t headSize)
{
    if (destination->kind == NN_LOCATOR_KIND_UDPv4 && watch->calls.takes(watch->calls.argument))
    {
        const size_t whole = SizeOf(parts, part);
        unsigned char *const datagram = CopyOf(whole, parts, part);
        if (datagram != NULL)
        {
            const struct RabitCycloneRoute route = RouteTo(connection, destination);
            watch->calls.take(watch->calls.argument, datagram, whole, &route, to);
            free(datagram);
            return (ssize_t)whole;
        }
    }
    const ssize_t size = Give(watch, connection, destination, parts, part, flags);
    if (size > 0)
    {
        watch->calls.sent(watch->calls.argument, head, headSize, (size_t)size);
    }
    return size;
}

/* Sends samples to the group. `participant`: prefix of their only addressee, added if they name none; NULL:
 * no INFO_DST is added. */
static void WriteToGroup(const struct Watch *watch, ddsi_tran_conn_t connection, size_t parts,
                         const ddsrt_iovec_t *part, uint32_t flags, const unsigned char *head,
                         size_t headSize, const unsigned char *participant)
{
    const bool isNamed = headSize > RtpsHeaderSize && head[RtpsHeaderSize] == InfoDestination[0];
    ddsrt_iovec_t all[MostParts + 3];
    size_t count = 0;
    all[count++] = (ddsrt_iovec_t){part[0].iov_base, RtpsHeaderSize};
    if (!isNamed && participant != NULL)
    {
        all[count++] = (ddsrt_iovec_t){(void *)InfoDestination, sizeof InfoDestination};
        all[count++] = (ddsrt_iovec_t){(void *)participant, PrefixSize};
    }
    all[count++] =
        (ddsrt_iovec_t){(unsigned char *)part[0].iov_base + RtpsHeaderSize, part[0].iov_len - RtpsHeaderSize};
    memcpy(all + count, part + 1, (parts - 1) * sizeof *part);
    count += parts - 1;
    WriteSamples(watch, connection, &watch->domain->loc_default_mc, RabitCycloneToSampleGroup, count, all,
                 flags, head, headSize);
}

static ssize_t WriteOne(ddsi_tran_conn_t connection, const ddsi_locator_t *destination, size_t parts,
                        const ddsrt_iovec_t *part, uint32_t flags, const unsigned char *participant)
{
    /* The watch exists as long as the domain's sockets. */
    const struct Watch watch = Find(connection->m_base.gv);
    if (watch.write == NULL)
    {
        return -1;
    }
    if (Hold(&watch, connection, destination, parts, part))
    {
        return (ssize_t)SizeOf(parts, part);
    }
    unsigned char head[HeadSize];
    const size_t filled = Gather(head, sizeof head, parts, part);
    const bool isDiscovery = watch.calls.isDiscovery(head, filled);
    const size_t whole = SizeOf(parts, part);
    if (!isDiscovery && !MayGo(&watch, destination, whole, true))
    {
        return (ssize_t)whole;
    }
    const struct RabitCycloneWays ways =
        isDiscovery || destination->kind != NN_LOCATOR_KIND_UDPv4 || IsGroup(destination) ||
                part[0].iov_len < RtpsHeaderSize || parts > MostParts
            ? (struct RabitCycloneWays){.host = true}
            : watch.calls.waysTo(watch.calls.argument, destination->address + AddressAt);
    if (ways.group)
    {
        WriteToGroup(&watch, connection, parts, part, flags, head, filled, participant);
    }
    ssize_t size = 0;
    if (isDiscovery)
    {
        size = WriteDiscovery(&watch, connection, destination, parts, part, flags);
        if (size > 0)
        {
            watch.calls.sent(watch.calls.argument, head, filled, (size_t)size);
        }
    }
    else if (ways.host)
    {
        size = WriteSamples(&watch, connection, destination, RabitCycloneToHost, parts, part, flags, head,
                            filled);
    }
    /* Datagrams that are not sent are reported to the vendor as sent, and sealed ones in the size that it
     * knows. */
    return size < 0 ? size : (ssize_t)whole;
}

static bool IsSame(const ddsi_locator_t *one, const ddsi_locator_t *other)
{
    return one->kind == other->kind && one->port == other->port &&
           memcmp(one->address, other->address, sizeof one->address) == 0;
}

/* The vendor sends a writer's sample on the thread that writes it, without delay, to the group or to each
 * reader. */
static ssize_t WriteAndTell(ddsi_tran_conn_t connection, const ddsi_locator_t *destination, size_t parts,
                            const ddsrt_iovec_t *part, uint32_t flags)
{
    if (!targets.chosen)
    {
        return WriteOne(connection, destination, parts, part, flags, NULL);
    }
    const ssize_t size = (ssize_t)SizeOf(parts, part);
    const bool isGroup = IsGroup(destination);
    for (size_t i = 0; i < targets.count; ++i)
    {
        const ddsi_xlocator_t *target = &targets.at[i];
        if (target->conn == connection && (isGroup || IsSame(&target->c, destination)))
        {
            WriteOne(connection, &target->c, parts, part, flags, targets.prefix[i]);
        }
    }
    return size;
}

/* `argument`: the participant. */
static void AddTarget(const ddsi_xlocator_t *locator, void *argument)
{
    const ddsi_guid_t *participant = argument;
    bool known = locator->c.kind != NN_LOCATOR_KIND_UDPv4 || IsGroup(&locator->c);
    for (size_t i = 0; i < targets.count; ++i)
    {
        if (targets.at[i].conn == locator->conn && IsSame(&targets.at[i].c, &locator->c))
        {
            known = true;
            /* Two participants, one address: for any (GUIDPREFIX_UNKNOWN). */
            memset(targets.prefix[i], 0, sizeof targets.prefix[i]);
        }
    }
    if (!known && targets.count < MostTargets)
    {
        for (size_t i = 0; i < PrefixSize / sizeof(uint32_t); ++i)
        {
            const uint32_t word = htonl(participant->prefix.u[i]);
            memcpy(targets.prefix[targets.count] + i * sizeof word, &word, sizeof word);
        }
        targets.at[targets.count++] = *locator;
    }
}

static bool FindReader(struct ddsi_writer *writer, const ddsi_guid_t *participant, ddsi_guid_t *reader)
{
    ddsrt_mutex_lock(&writer->e.lock);
    const struct ddsi_wr_prd_match *const match = FindMatch(writer, participant);
    if (match != NULL)
    {
        *reader = match->prd_guid;
    }
    ddsrt_mutex_unlock(&writer->e.lock);
    return match != NULL;
}

/* Uses the reader's address, not the one that its participant announced: the vendor keeps only a
 * participant's first announced address, which may be forged. */
void RabitCycloneWriteTo(const struct ddsi_sertype *type, const ddsi_guid_t *writer,
                         const ddsi_guid_t *participants, size_t count)
{
    struct ddsi_domaingv *domain = ddsrt_atomic_ldvoidp(&type->gv);
    targets.chosen = true;
    targets.count = 0;
    if (domain == NULL)
    {
        return;
    }
    thread_state_awake(lookup_thread_state(), domain);
    struct ddsi_writer *known = entidx_lookup_writer_guid(domain->entity_index, writer);
    for (size_t i = 0; i < count && known != NULL; ++i)
    {
        ddsi_guid_t guid;
        struct ddsi_proxy_reader *reader = FindReader(known, &participants[i], &guid)
                                               ? entidx_lookup_proxy_reader_guid(domain->entity_index, &guid)
                                               : NULL;
        if (reader != NULL)
        {
            ddsrt_mutex_lock(&reader->e.lock);
            addrset_forall(reader->c.as, AddTarget, &guid);
            ddsrt_mutex_unlock(&reader->e.lock);
        }
    }
    thread_state_asleep(lookup_thread_state());
}

void RabitCycloneWriteToAll(void)
{
    targets.chosen = false;
}

static ssize_t ReadAndTell(ddsi_tran_conn_t connection, unsigned char *buffer, size_t size,
                           bool allowSpurious, ddsi_locator_t *source)
{
    const struct Watch watch = Find(connection->m_base.gv);
    if (watch.read == NULL)
    {
        return -1;
    }
    const ssize_t got = watch.read(connection, buffer, size, allowSpurious, source);
    if (got <= 0)
    {
        return got;
    }
    const bool isKnown = source != NULL && source->kind == NN_LOCATOR_KIND_UDPv4;
    const struct RabitCyclonePlace from = isKnown ? PlaceOf(source) : (struct RabitCyclonePlace){.port = 0};
    /* The vendor ignores a datagram of no bytes. */
    return (ssize_t)watch.calls.received(watch.calls.argument, buffer, (size_t)got, size,
                                         isKnown ? &from : NULL, connection == watch.domain->disc_conn_uc);
}

struct Copy
{
    const struct ddsi_domaingv *domain;
    struct addrset *to;
};

static void CopyLocator(const ddsi_xlocator_t *locator, void *argument)
{
    const struct Copy *copy = argument;
    add_xlocator_to_addrset(copy->domain, copy->to, locator);
}

struct Host
{
    bool isFound;
    ddsi_xlocator_t locator;
};

static void NoteHost(const ddsi_xlocator_t *locator, void *argument)
{
    struct Host *host = argument;
    if (locator->c.kind == NN_LOCATOR_KIND_UDPv4 && !IsGroup(&locator->c))
    {
        host->isFound = true;
        host->locator = *locator;
    }
}

/* A thread of the vendor's may be about to read a datagram by the former function. A domain with keys is deaf
 * meanwhile. */
static void WatchReading(const struct Watch *watch, ddsi_tran_conn_t connection)
{
    if (connection->m_read_fn == watch->read)
    {
        __atomic_store_n(&connection->m_read_fn, ReadAndTell, __ATOMIC_RELEASE);
    }
}

/* For a network without multicast, and without peers, the vendor announces its participant at each port that
 * a participant of this host may have. These are some hundred datagrams, and use up what strangers may be
 * sent. */
static void AnnounceToListedAlone(struct ddsi_domaingv *domain)
{
    if (domain->config.peers != NULL)
    {
        return;
    }
    /* Each port is removed while no set is locked. */
    for (int i = 0; i <= UINT16_MAX; ++i)
    {
        struct Host host = {.isFound = false};
        addrset_forall(domain->as_disc, NoteHost, &host);
        if (!host.isFound)
        {
            return;
        }
        remove_from_addrset(domain, domain->as_disc, &host.locator);
    }
}

void *RabitCycloneWatch(struct RabitCycloneCalls calls)
{
    struct ddsi_domaingv *domain = ddsrt_atomic_ldvoidp(&lookup_thread_state()->gv);
    /* Without UDP there may be no such sockets. */
    const bool hasSockets = domain != NULL && domain->n_interfaces > 0 && domain->xmit_conns[0] != NULL &&
                            domain->disc_conn_uc != NULL;
    struct Watch *watch = hasSockets ? malloc(sizeof *watch) : NULL;
    if (watch == NULL)
    {
        return NULL;
    }
    watch->domain = domain;
    watch->write = domain->xmit_conns[0]->m_write_fn;
    watch->read = domain->disc_conn_uc->m_read_fn;
    watch->calls = calls;
    AnnounceToListedAlone(domain);
    watch->listed = new_addrset();
    struct Copy copy = {domain, watch->listed};
    addrset_forall(domain->as_disc, CopyLocator, &copy);
    pthread_rwlock_wrlock(&lock);
    watch->next = first;
    first = watch;
    pthread_rwlock_unlock(&lock);
    /* No datagram is sent before there is a participant. */
    for (int i = 0; i < domain->n_interfaces; ++i)
    {
        if (domain->xmit_conns[i]->m_write_fn == watch->write)
        {
            domain->xmit_conns[i]->m_write_fn = WriteAndTell;
        }
    }
    /* The vendor reads from the sockets that send as well (OpenDDS answers to them). */
    for (int i = 0; i < domain->n_interfaces; ++i)
    {
        WatchReading(watch, domain->xmit_conns[i]);
    }
    ddsi_tran_conn_t reading[] = {domain->disc_conn_mc, domain->disc_conn_uc, domain->data_conn_mc,
                                  domain->data_conn_uc};
    for (size_t i = 0; i < sizeof reading / sizeof reading[0]; ++i)
    {
        if (reading[i] == NULL)
        {
            continue;
        }
        WatchReading(watch, reading[i]);
        /* The vendor sends nothing by these sockets. */
        if (calls.seal != NULL && reading[i]->m_write_fn == watch->write)
        {
            reading[i]->m_write_fn = WriteAndTell;
        }
    }
    return watch;
}

static bool IsEachWatched(const struct ddsi_domaingv *domain)
{
    for (int i = 0; i < domain->n_interfaces; ++i)
    {
        if (domain->xmit_conns[i] == NULL || domain->xmit_conns[i]->m_write_fn != WriteAndTell ||
            domain->xmit_conns[i]->m_read_fn != ReadAndTell)
        {
            return false;
        }
    }
    const ddsi_tran_conn_t reading[] = {domain->disc_conn_mc, domain->disc_conn_uc, domain->data_conn_mc,
                                        domain->data_conn_uc};
    for (size_t i = 0; i < sizeof reading / sizeof reading[0]; ++i)
    {
        if (reading[i] != NULL && reading[i]->m_read_fn != ReadAndTell)
        {
            return false;
        }
    }
    return true;
}

bool RabitCycloneHasSecurity(const void *watch)
{
#ifdef DDS_HAS_SECURITY
    return RabitCycloneDomainOf(watch)->config.omg_security_configuration != NULL;
#else
    (void)watch;
    return false;
#endif
}

const char *RabitCyclonePassesBy(const void *watch)
{
    const struct ddsi_domaingv *domain = RabitCycloneDomainOf(watch);
    const struct ddsi_config *config = &domain->config;
    if (domain->loc_meta_uc.kind != NN_LOCATOR_KIND_UDPv4 || domain->listener != NULL)
    {
        return "its transport is not UDP over IPv4";
    }
    if (config->many_sockets_mode != DDSI_MSM_SINGLE_UNICAST)
    {
        return "ManySocketsMode is not single";
    }
    /* A thread of one socket alone may wait in the vendor's own read function, before it is replaced. */
    if (config->multiple_recv_threads != DDSI_BOOLDEF_FALSE)
    {
        return "it has MultipleReceiveThreads";
    }
    if (config->monitor_port >= 0)
    {
        return "it has a MonitorPort";
    }
    /* What comes before all sockets are watched must be lost. */
    if (!config->initial_deaf || config->initial_deaf_mute_reset != DDS_INFINITY)
    {
        return "its ControlTopic lets datagrams in before they are checked";
    }
#ifdef DDS_HAS_SHM
    if (config->enable_shm)
    {
        return "it has SharedMemory";
    }
#endif
    return IsEachWatched(domain) ? NULL : "a socket is of another kind";
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
    if (watch != NULL)
    {
        unref_addrset(((struct Watch *)watch)->listed);
    }
    free(watch);
}

/* The locators of a set at one address: one for each interface. */
struct AtPlace
{
    const struct RabitCyclonePlace *place;
    size_t count;
    ddsi_xlocator_t found[MostTargets];
};

static void FindAtPlace(const ddsi_xlocator_t *locator, void *argument)
{
    struct AtPlace *at = argument;
    if (locator->c.kind == NN_LOCATOR_KIND_UDPv4 && locator->c.port == at->place->port &&
        memcmp(locator->c.address + AddressAt, at->place->address, sizeof at->place->address) == 0 &&
        at->count < MostTargets)
    {
        at->found[at->count++] = *locator;
    }
}

void RabitCycloneAnnounceNoMoreTo(const void *watch, const struct RabitCyclonePlace *place)
{
    const struct Watch *of = watch;
    if (of == NULL)
    {
        return;
    }
    struct AtPlace listed = {.place = place};
    addrset_forall(of->listed, FindAtPlace, &listed);
    struct AtPlace heard = {.place = place};
    if (listed.count == 0)
    {
        addrset_forall(of->domain->as_disc, FindAtPlace, &heard);
    }
    for (size_t i = 0; i < heard.count; ++i)
    {
        remove_from_addrset(of->domain, of->domain->as_disc, &heard.found[i]);
    }
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

static ddsi_locator_t LocatorOf(const struct Watch *watch, const struct RabitCycloneRoute *route)
{
    ddsi_locator_t locator = watch->domain->loc_default_mc;
    locator.kind = NN_LOCATOR_KIND_UDPv4;
    locator.port = route->port;
    memset(locator.address, 0, sizeof locator.address);
    memcpy(locator.address + AddressAt, route->address, sizeof route->address);
    return locator;
}

size_t RabitCycloneSend(const void *watch, const struct RabitCycloneRoute *route, enum RabitCycloneTo to,
                        const unsigned char *datagram, size_t size)
{
    const struct Watch *of = watch;
    const ddsi_locator_t destination =
        to == RabitCycloneToHost ? LocatorOf(of, route) : of->domain->loc_default_mc;
    const ddsrt_iovec_t whole = {(void *)datagram, size};
    const ssize_t given = Give(of, route->connection, &destination, 1, &whole, 0);
    return given > 0 ? (size_t)given : 0;
}

bool RabitCycloneSendSealed(const void *watch, const struct RabitCycloneRoute *route,
                            const unsigned char *datagram, size_t size)
{
    const struct Watch *of = watch;
    const ddsi_locator_t destination = LocatorOf(of, route);
    const ddsrt_iovec_t whole = {(void *)datagram, size};
    return of->write(route->connection, &destination, 1, &whole, 0) > 0;
}

struct ddsi_domaingv *RabitCycloneDomainOf(const void *watch)
{
    return ((const struct Watch *)watch)->domain;
}

void RabitCycloneWake(const void *watch)
{
    const struct Watch *of = watch;
    unsigned char nothing = 0;
    const ddsrt_iovec_t whole = {&nothing, sizeof nothing};
    of->write(of->domain->xmit_conns[0], &of->domain->loc_meta_uc, 1, &whole, 0);
}
